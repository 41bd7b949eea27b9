// The loss of the display, heard before the program ends because of it. Qt and Xlib then call
// exit() or abort(), and exit() destroys what threads of a running session still use.
#pragma once

namespace dihaptic::gui {

/// Calls `act`, in any thread, once the display is lost; at a fatal message of Qt too. Without a
/// session `act` returns, and the program ends as Qt or Xlib will have it. Call it after the
/// application object was made.
void at_display_loss(void (*act)());

}  // namespace dihaptic::gui
