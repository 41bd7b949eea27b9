#include "terminal_guide.h"

#include <fmt/format.h>
#include <poll.h>
#include <unistd.h>

#include <iostream>

namespace dihaptic::cli {

TerminalGuide::TerminalGuide(const std::string& label, std::string skip)
    : line_(label), skip_(std::move(skip)) {}

rig::Guide TerminalGuide::guide() {
    return {[this](const rig::Guidance& now) { show(now); }, [this] { return done(); }};
}

void TerminalGuide::show(const rig::Guidance& now) {
    if (now.step != step_) {
        step_ = now.step;
        line_.clear();
        fmt::print("{} of {}. {}\n   Then press Enter{}.\n", now.step, now.steps, now.text,
                   skip_.empty() ? "" : fmt::format(" ({} and Enter: without this)", skip_));
        std::fflush(stdout);
        return;
    }
    line_.show(now.share, now.measured);
}

bool TerminalGuide::done() {
    if (stop_requested) throw rig::GivenUp{};
    pollfd input{STDIN_FILENO, POLLIN, 0};
    if (step_ == 0 || poll(&input, 1, 0) <= 0) return false;
    std::string answer;
    if (!std::getline(std::cin, answer) || (!skip_.empty() && answer == skip_))
        throw rig::GivenUp{};
    return true;
}

}  // namespace dihaptic::cli
