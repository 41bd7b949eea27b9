// Shows pages of the manual in the browser: those of the package dihaptic-doc, those that
// ./dev docs has made, or the texts that they are made from.
#pragma once

#include <QString>

namespace dihaptic::gui {

/// `name`: of a page, such as "window"; "index": the whole manual. Returns why it cannot be shown;
/// "" if it is.
QString show_help_page(const QString& name);

}  // namespace dihaptic::gui
