// The names of a table's columns as an operator reads them.
#pragma once

#include <QString>

namespace dihaptic::gui {

/// The name of a column in words, with its unit: "hand angle [deg]" for "hand_angle_deg". The
/// column's own name, which files and other programs use, belongs into a tooltip.
QString column_words(const QString& name);

}  // namespace dihaptic::gui
