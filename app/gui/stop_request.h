// A request from outside to end the program. The running session receives the request through a
// flag, in its next tick, and the window receives it through its event loop.
#pragma once

#include <QObject>
#include <atomic>

namespace dihaptic::gui {

class StopRequest : public QObject {
    Q_OBJECT

  public:
    /// From now on, signals that would end the program are handled here (common/stop_signals.h). A
    /// program must not have more than one StopRequest.
    StopRequest();

    /// Set by a signal, or by other code that ends the program.
    std::atomic<bool>& flag();

  Q_SIGNALS:
    void came(int signal);
};

}  // namespace dihaptic::gui
