// The panel for the knobs that may be changed while a session runs. Changes take effect in one of
// the next ticks.
#pragma once

#include <QFormLayout>
#include <QWidget>
#include <functional>
#include <vector>

#include "frame/knobs.h"

namespace dihaptic::gui {

class TuningPanel : public QWidget {
    Q_OBJECT

  public:
    explicit TuningPanel(QWidget* parent = nullptr);

    /// Shows the knobs with which the session starts.
    void set_knobs(const frame::Knobs& knobs);

  Q_SIGNALS:
    /// `what`: the knob that the user turned, and its value, as text.
    void turned(const dihaptic::frame::Knobs& knobs, const QString& what);

  private:
    /// Adds a knob with the widget that shows its value.
    template <NamedEnum E>
    void add(QFormLayout* form, E frame::Knobs::*knob, const frame::Knob& is);
    void add(QFormLayout* form, double frame::Knobs::*knob, const frame::Knob& is);
    template <class T>
    void turn(T frame::Knobs::*knob, const frame::Knob& is, T value);

    frame::Knobs knobs_;
    std::vector<std::function<void()>> show_;  // for each knob, shows its value in knobs_
    bool setting_ = false;  // whether the program, not the user, is setting values
};

}  // namespace dihaptic::gui
