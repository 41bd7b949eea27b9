// Shows pages of the manual in the browser: the pages of the package dihaptic-doc, or those built
// by ./dev docs.
#pragma once

#include <QString>

namespace dihaptic::gui {

/// Shows the page with this name, e.g. "window"; "index" is the start page of the manual. If the
/// page cannot be shown, returns the reason, otherwise "".
QString show_help_page(const QString& name);

}  // namespace dihaptic::gui
