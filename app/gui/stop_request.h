// That somebody outside of the window wants the program to end, as the session that runs and the
// window are told: the one by a flag, for its next tick, the other by its event loop.
#pragma once

#include <QObject>
#include <atomic>

namespace dihaptic::gui {

class StopRequest : public QObject {
    Q_OBJECT

  public:
    /// From now on signals that end a program come here (common/stop_signals.h). One a program.
    StopRequest();

    /// Set by a signal, or by whoever ends the program.
    std::atomic<bool>& flag();

  Q_SIGNALS:
    void came(int signal);
};

}  // namespace dihaptic::gui
