// Listens for Escape in a separate thread, so that force can be switched off even while the window
// hangs or draws slowly.
#pragma once

#include <QObject>
#include <atomic>
#include <thread>

#include "base/descriptor.h"

namespace dihaptic::gui {

/// Works only on X11. On other systems it has no effect, and Escape is handled like any other key
/// (Application).
class EscapeListener : public QObject {
    Q_OBJECT

  public:
    /// To be called after the QGuiApplication has been created.
    EscapeListener();
    ~EscapeListener() override;

  Q_SIGNALS:
    /// Emitted in the listener's thread whenever Escape is pressed while a window of this program
    /// is active.
    void heard();

  private:
    void listen();

    std::atomic<bool> active_{false};
    Descriptor quit_;  ///< an eventfd
    std::thread thread_;
};

}  // namespace dihaptic::gui
