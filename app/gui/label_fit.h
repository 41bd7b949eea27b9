// Sizes a label that overlays the scene to fit its text, wrapping it onto several lines if
// necessary.
#pragma once

#include <QLabel>

namespace dihaptic::gui {

/// Resizes the label to fit its text, at most `widest` pixels wide.
inline void fit_label(QLabel& label, int widest) {
    label.setWordWrap(false);
    label.setMinimumWidth(0);
    label.setMaximumWidth(QWIDGETSIZE_MAX);
    label.ensurePolished();  // a widget has no style until it is shown
    label.adjustSize();
    if (label.width() <= widest) return;
    label.setWordWrap(true);
    label.setFixedWidth(widest);
    label.adjustSize();
}

}  // namespace dihaptic::gui
