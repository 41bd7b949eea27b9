// Shows pages of the manual in the browser: those of the package dihaptic-doc, those made by ./dev
// docs, or the texts from which they are made.
#pragma once

#include <QString>

namespace dihaptic::gui {

/// `name` of a page, such as "window"; "index" is the whole manual. Returns the reason if it cannot
/// be shown, otherwise "".
QString show_help_page(const QString& name);

}  // namespace dihaptic::gui
