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

/// Where a session stood when it was first looked at: a session that continues another one begins
/// with trials that are done already.
struct ProgressStart {
    double time = 0;  ///< session time [s]
    double done = 0;  ///< share of completed trials
};

/// `done`: share of completed trials. `pace`: ratio of session time to wall time, since the
/// remaining time is that of the person who waits. Without trials or a script, only the elapsed
/// time is known.
SessionProgress progress_of(const session::Plan& plan, const frame::Frame& frame, double done,
                            double pace, const ProgressStart& start = {});

/// A duration as somebody would say it who estimates [s].
QString roughly(double seconds);

}  // namespace dihaptic::gui
