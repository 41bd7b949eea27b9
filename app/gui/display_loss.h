// Detects the loss of the display before the program ends because of it. After such a loss, Qt and
// Xlib call exit() or abort(), and exit() destroys objects that the threads of a running session
// still use.
#pragma once

namespace dihaptic::gui {

/// Calls `act`, in any thread, once the display is lost, and also after a fatal message of Qt. If
/// no session runs, `act` returns, and the program ends as Qt or Xlib decides. To be called after
/// the application object has been created.
void at_display_loss(void (*act)());

}  // namespace dihaptic::gui
