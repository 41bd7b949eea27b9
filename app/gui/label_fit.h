// Sizes a label that overlays the scene to fit its text, wrapping it onto several lines if
// necessary; and finds the room that a screen has for a window.
#pragma once

#include <QApplication>
#include <QLabel>
#include <QScreen>
#include <QStyle>

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

/// The largest size of a window, without its frame, of which `beside` fit next to each other on the
/// screen. The frame is not known before the window is shown, so that room for a usual one is kept.
inline QSize room_on(const QScreen& screen, int beside = 1) {
    const QStyle& style = *QApplication::style();
    constexpr int kEdge = 8;  // [pixels]
    const int title = style.pixelMetric(QStyle::PM_TitleBarHeight) + 2 * kEdge;
    const QSize all = screen.availableSize();
    return {all.width() / beside - 2 * kEdge, all.height() - title - kEdge};
}

}  // namespace dihaptic::gui
