// A request from outside that the program should end. The running session gets it by a flag, in its
// next tick, and the window by its event loop.
#pragma once

#include <QObject>
#include <atomic>

namespace dihaptic::gui {

class StopRequest : public QObject {
    Q_OBJECT

  public:
    /// From now on signals that end a program come here (common/stop_signals.h). A program has only
    /// one StopRequest.
    StopRequest();

    /// Set by a signal, or by other code that ends the program.
    std::atomic<bool>& flag();

  Q_SIGNALS:
    void came(int signal);
};

}  // namespace dihaptic::gui
