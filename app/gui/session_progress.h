// Describes the progress of a session in words.
#pragma once

#include <QString>

#include "frame/frame.h"
#include "session/plan.h"

namespace dihaptic::gui {

struct SessionProgress {
    QString trial;     ///< its number and the number of trials; "" without trials
    QString names;     ///< its round, block and condition, and the attempt; "" without trials
    double share = 0;  ///< completed share of the session
    QString text;      ///< remaining time or, if that is unknown, elapsed time
};

/// `done`: share of completed trials. `pace`: ratio of session time to wall time, since the
/// remaining time is that of the person who waits. Without trials or a script, only the elapsed
/// time is known.
SessionProgress progress_of(const session::Plan& plan, const frame::Frame& frame, double done,
                            double pace);

/// A duration as somebody would say it who estimates [s].
QString roughly(double seconds);

}  // namespace dihaptic::gui
