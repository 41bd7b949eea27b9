#include "terminal_guide.h"

#include <fmt/format.h>
#include <poll.h>
#include <unistd.h>

#include <array>

namespace dihaptic::cli {

rig::Guide TerminalGuide::guide() {
    return {[this](const rig::Guidance& now) { show(now); }, [this] { return done(); }};
}

void TerminalGuide::show(const rig::Guidance& now) {
    if (now.step != step_) {
        step_ = now.step;
        line_.clear();
        fmt::print("{} of {}. {}\n   Then press Enter.\n", now.step, now.steps, now.text);
        std::fflush(stdout);
        return;
    }
    line_.show(now.share, now.measured);
}

bool TerminalGuide::read_input() {
    pollfd input{STDIN_FILENO, POLLIN, 0};
    while (poll(&input, 1, 0) > 0) {
        std::array<char, 256> bytes;
        const ssize_t count = read(STDIN_FILENO, bytes.data(), bytes.size());
        if (count <= 0) return false;
        typed_.append(bytes.data(), static_cast<size_t>(count));
    }
    return true;
}

bool TerminalGuide::done() {
    if (stop_requested) throw rig::GivenUp{};
    if (step_ == 0) return false;
    const bool more = read_input();
    const size_t end = typed_.find('\n');
    if (end == std::string::npos) {
        if (!more) throw rig::GivenUp{};
        return false;
    }
    typed_.erase(0, end + 1);
    return true;
}

}  // namespace dihaptic::cli
