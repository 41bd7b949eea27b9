// The window's theme, dark or light.
#pragma once

namespace dihaptic::gui {

/// Sets the theme of the whole program.
void set_dark(bool dark);

}  // namespace dihaptic::gui
