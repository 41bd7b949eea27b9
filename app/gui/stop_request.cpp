#include "stop_request.h"

#include <fcntl.h>
#include <unistd.h>

#include <QSocketNotifier>
#include <array>

#include "common/stop_signals.h"

namespace dihaptic::gui {
namespace {

std::atomic<bool> stop_requested{false};  // static: signals may come until the end

}  // namespace

StopRequest::StopRequest() {
    std::array<int, 2> ends{-1, -1};
    if (pipe2(ends.data(), O_CLOEXEC | O_NONBLOCK) == 0) {
        auto* notifier = new QSocketNotifier(ends[0], QSocketNotifier::Read, this);
        connect(notifier, &QSocketNotifier::activated, this, [this, file = ends[0]] {
            char signal = 0;
            while (read(file, &signal, 1) == 1) Q_EMIT came(signal);
        });
    }
    app::stop_on_signals(stop_requested, ends[1]);
}

std::atomic<bool>& StopRequest::flag() {
    return stop_requested;
}

}  // namespace dihaptic::gui
