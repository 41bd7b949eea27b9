// Describes the progress of a session in words.
#pragma once

#include <QString>

#include "frame/frame.h"
#include "session/plan.h"

namespace dihaptic::gui {

struct SessionProgress {
    QString trial;     ///< its number, the number of trials, and its name; "" without trials
    double share = 0;  ///< completed share of the session
    QString text;      ///< remaining time or, if that is unknown, elapsed time
};

/// `done`: share of completed trials. Without trials or a script, only the elapsed time is known.
SessionProgress progress_of(const session::Plan& plan, const frame::Frame& frame, double done);

}  // namespace dihaptic::gui
