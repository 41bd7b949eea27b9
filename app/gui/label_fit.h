// Fits a label over the scene to its text, in several lines if necessary.
#pragma once

#include <QLabel>

namespace dihaptic::gui {

/// Gives the label the size of its text, at most `widest` pixels across.
inline void fit_label(QLabel& label, int widest) {
    label.setWordWrap(false);
    label.setMinimumWidth(0);
    label.setMaximumWidth(QWIDGETSIZE_MAX);
    label.ensurePolished();  // a widget that is never shown has no style before
    label.adjustSize();
    if (label.width() <= widest) return;
    label.setWordWrap(true);
    label.setFixedWidth(widest);
    label.adjustSize();
}

}  // namespace dihaptic::gui
