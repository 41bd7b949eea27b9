// Listens for Escape in a separate thread, so that a window that draws slowly, or hangs, does not
// keep force on.
#pragma once

#include <QObject>
#include <atomic>
#include <thread>

#include "base/descriptor.h"

namespace dihaptic::gui {

/// Works only on X11; elsewhere it has no effect, and Escape is handled like any other key
/// (Application).
class EscapeListener : public QObject {
    Q_OBJECT

  public:
    /// Call after the QGuiApplication is made.
    EscapeListener();
    ~EscapeListener() override;

  Q_SIGNALS:
    /// Emitted in the listener's thread, at each press of Escape while a window of this program is
    /// the active one.
    void heard();

  private:
    void listen();

    std::atomic<bool> active_{false};
    Descriptor quit_;  ///< an eventfd
    std::thread thread_;
};

}  // namespace dihaptic::gui
