// The panel for the knobs that can be changed while a session runs. A change takes effect within a
// few ticks.
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

    /// Sets the knobs to the values with which the session starts.
    void set_knobs(const frame::Knobs& knobs);

  Q_SIGNALS:
    /// `what`: the knob that the user changed and its new value, as text.
    void turned(const dihaptic::frame::Knobs& knobs, const QString& what);

  private:
    /// Adds a knob, with the widget that shows its value.
    template <NamedEnum E>
    void add(QFormLayout* form, E frame::Knobs::*knob, const frame::Knob& is);
    void add(QFormLayout* form, double frame::Knobs::*knob, const frame::Knob& is);
    template <class T>
    void turn(T frame::Knobs::*knob, const frame::Knob& is, T value);

    frame::Knobs knobs_;
    std::vector<std::function<void()>> show_;  // for each knob, shows its value in knobs_
    bool setting_ = false;  // whether the values are being set by the program, not by the user
};

}  // namespace dihaptic::gui
