// Dark or light.
#pragma once

namespace dihaptic::gui {

/// Of the whole program.
void set_dark(bool dark);

}  // namespace dihaptic::gui
