// The panel for what may be changed while a session runs, from one of the next ticks on, and for
// the proxy of the next session while none runs.
#pragma once

#include <QComboBox>
#include <QDoubleSpinBox>

#include "servo/settings.h"

namespace dihaptic::gui {

class TuningPanel : public QWidget {
    Q_OBJECT

  public:
    explicit TuningPanel(QWidget* parent = nullptr);

    /// Shows the settings with which the session starts.
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
    bool setting_ = false;  // values are being set by the program, not by its user
};

}  // namespace dihaptic::gui
