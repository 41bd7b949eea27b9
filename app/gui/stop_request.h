// A request from outside to end the program. The running session receives it through a flag, in its
// next tick, and the window through its event loop.
#pragma once

#include <QObject>
#include <atomic>

namespace dihaptic::gui {

class StopRequest : public QObject {
    Q_OBJECT

  public:
    /// From now on, signals that would end the program arrive here (common/stop_signals.h). A
    /// program has only one StopRequest.
    StopRequest();

    /// Set by a signal, or by other code that ends the program.
    std::atomic<bool>& flag();

  Q_SIGNALS:
    void came(int signal);
};

}  // namespace dihaptic::gui
