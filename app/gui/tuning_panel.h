// What may be changed while a session runs, from one of the next ticks on; and, while none does,
// the proxy of the next.
#pragma once

#include <QComboBox>
#include <QDoubleSpinBox>

#include "servo/settings.h"

namespace dihaptic::gui {

class TuningPanel : public QWidget {
    Q_OBJECT

  public:
    explicit TuningPanel(QWidget* parent = nullptr);

    /// As the session starts with them.
    void set_settings(const servo::Settings& settings);

  Q_SIGNALS:
    void solver_chosen(dihaptic::dynamics::Solver solver);
    void friction_scaled(double scale);
    void tuned(const dihaptic::haptics::Tuning& tuning);
    void proxy_chosen(dihaptic::scene::ProxyKind kind);

  private:
    void tune();

    QComboBox* proxy_;
    QComboBox* coupling_;
    QDoubleSpinBox* stiffness_;
    QDoubleSpinBox* damping_;
    QDoubleSpinBox* smoothing_;
    QComboBox* solver_;
    QDoubleSpinBox* friction_;
    bool setting_ = false;  // by the program, not by its user
};

}  // namespace dihaptic::gui
