#include "lost_windows.h"

#include <xcb/xcb.h>

#include <QCoreApplication>
#include <QPointer>

namespace dihaptic::gui {

LostWindows::LostWindows() {
    qApp->installNativeEventFilter(this);
}

bool LostWindows::nativeEventFilter(const QByteArray& kind, void* message, qintptr*) {
    if (kind != "xcb_generic_event_t") return false;
    const auto& event = *static_cast<const xcb_generic_event_t*>(message);
    if ((event.response_type & 0x7f) != XCB_DESTROY_NOTIFY) return false;
    const auto& gone = reinterpret_cast<const xcb_destroy_notify_event_t&>(event);
    // find() returns no widget if the program itself destroyed the window
    const QPointer<QWidget> window = QWidget::find(gone.window);
    if (!window || !window->isWindow()) return false;
    QMetaObject::invokeMethod(
        this,
        [this, window] {
            if (window) Q_EMIT lost(window);
        },
        Qt::QueuedConnection);
    return false;
}

}  // namespace dihaptic::gui
