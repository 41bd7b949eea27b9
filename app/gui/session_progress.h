// The progress of a session, in words.
#pragma once

#include <QString>

#include "frame/frame.h"
#include "session/plan.h"

namespace dihaptic::gui {

struct SessionProgress {
    QString trial;     ///< its number, out of how many, and its name; empty without trials
    double share = 0;  ///< share of the session that is over
    QString text;      ///< remaining time, or the time so far if that is unknown
};

/// `done`: share of the trials that are over. Without trials or a script only the time is known.
SessionProgress progress_of(const session::Plan& plan, const frame::Frame& frame, double done);

}  // namespace dihaptic::gui
