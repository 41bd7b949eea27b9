// The panel for what may be changed while a session runs, from one of the next ticks on.
#pragma once

#include <QFormLayout>
#include <QWidget>
#include <functional>
#include <vector>

#include "servo/knobs.h"

namespace dihaptic::gui {

class TuningPanel : public QWidget {
    Q_OBJECT

  public:
    explicit TuningPanel(QWidget* parent = nullptr);

    /// Shows the knobs with which the session starts.
    void set_knobs(const servo::Knobs& knobs);

  Q_SIGNALS:
    /// `what`: the knob that its user turned, and its value, in words.
    void turned(const dihaptic::servo::Knobs& knobs, const QString& what);

  private:
    /// Adds a knob with what shows its value.
    template <NamedEnum E>
    void add(QFormLayout* form, E servo::Knobs::*knob, const servo::Knob& is);
    void add(QFormLayout* form, double servo::Knobs::*knob, const servo::Knob& is);
    template <class T>
    void turn(T servo::Knobs::*knob, const servo::Knob& is, T value);

    servo::Knobs knobs_;
    std::vector<std::function<void()>> show_;  // by knob: shows its value in knobs_
    bool setting_ = false;  // values are being set by the program, not by its user
};

}  // namespace dihaptic::gui
