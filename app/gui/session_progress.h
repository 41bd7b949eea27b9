// How far a session is, in words.
#pragma once

#include <QString>

#include "experiment/plan.h"
#include "servo/frame.h"

namespace dihaptic::gui {

struct SessionProgress {
    QString trial;  ///< which of how many, and what it is; empty without trials
    double share = 0;
    QString text;  ///< how much is left, as far as that is known
};

/// `done`: share of the trials that are over. Without trials or a script time alone is known.
SessionProgress progress_of(const experiment::Plan& plan, const servo::Frame& frame, double done);

}  // namespace dihaptic::gui
