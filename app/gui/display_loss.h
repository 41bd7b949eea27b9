// Detects the loss of the display before the program ends because of it. Qt and Xlib then call
// exit() or abort(), and exit() destroys objects that threads of a running session still use.
#pragma once

namespace dihaptic::gui {

/// Calls `act`, in any thread, once the display is lost, and also at a fatal message of Qt. Without
/// a session `act` returns, and the program ends as Qt or Xlib decides. Call it after the
/// application object was made.
void at_display_loss(void (*act)());

}  // namespace dihaptic::gui
