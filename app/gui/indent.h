// The indentation of a new line in a YAML file.
#pragma once

#include <QString>

namespace dihaptic::gui {

/// Number of spaces with which a line after `line` begins, where `line` is the text before the
/// cursor. A key of the same mapping is below the previous key, a value is below and to the right
/// of its key, and an item follows a whole item of a list.
int indent_after(const QString& line);

}  // namespace dihaptic::gui
