// Says in words what the session is doing, what is the case for the person's hand, and what to do
// next.
#pragma once

#include "session_control.h"
#include "theme.h"

namespace dihaptic::gui {

struct SessionSign {
    Sign sign;
    QString word;  ///< e.g. "Paused"
    QString text;  ///< one or two sentences
};

SessionSign sign_of(const SessionControl& control);

/// The words of the button that pauses and resumes, and of the one that ends or cancels.
QString word_for_pause(SessionControl::State state);
QString word_for_stop(SessionControl::State state);

}  // namespace dihaptic::gui
