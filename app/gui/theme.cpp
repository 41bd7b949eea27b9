#include "theme.h"

#include <QApplication>
#include <QColor>
#include <QPalette>
#include <QStyleFactory>

namespace dihaptic::gui {

void set_dark(bool dark) {
    QApplication::setStyle(QStyleFactory::create("Fusion"));
    const QColor window = dark ? "#2b2f36" : "#f3f2ef";
    const QColor base = dark ? "#21252b" : "#ffffff";
    const QColor text = dark ? "#e6e6e3" : "#20242a";
    const QColor button = dark ? "#3a3f48" : "#e4e2dc";
    const QColor highlight = dark ? "#4a90d9" : "#0072b2";
    QPalette palette(text, button, button.lighter(120), button.darker(160), button.darker(120),
                     text, Qt::white, base, window);
    palette.setColor(QPalette::Highlight, highlight);
    palette.setColor(QPalette::HighlightedText, Qt::white);
    palette.setColor(QPalette::Link, highlight);
    palette.setColor(QPalette::PlaceholderText, dark ? "#9aa0a8" : "#73777d");
    palette.setColor(QPalette::ToolTipBase, base);
    palette.setColor(QPalette::ToolTipText, text);
    for (const auto role : {QPalette::WindowText, QPalette::Text, QPalette::ButtonText})
        palette.setColor(QPalette::Disabled, role, dark ? "#7b8087" : "#9a9a96");
    QApplication::setPalette(palette);
}

}  // namespace dihaptic::gui
