// Finds the command-line program, with which the window makes new files and draws small pictures.
#pragma once

#include <QString>

namespace dihaptic::gui {

/// Path of the program `dihaptic`: next to this one, as in a build folder, or in the folder `bin`
/// of the same installation. "" if there is none.
QString main_program();

/// What to say if it is missing.
QString main_program_is_missing();

}  // namespace dihaptic::gui
