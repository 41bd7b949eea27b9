#include "command.h"

#include <fmt/format.h>
#include <unistd.h>

#include <charconv>
#include <cstdio>
#include <limits>

namespace dihaptic::cli {

std::atomic<bool> stop_requested{false};
int exit_code = kOk;

namespace {

std::string typed;

/// Writes to standard error. Ignores failure: if the terminal is gone, a session is finished
/// without progress.
void say(const std::string& text) {
    std::fputs(text.c_str(), stderr);
    std::fflush(stderr);
}

}  // namespace

std::string command_line() {
    return typed;
}

void remember_command_line(int argc, char** argv) {
    for (int i = 0; i < argc; ++i)
        typed += (i > 0 ? " " : "") + std::string(i == 0 ? "dihaptic" : argv[i]);
}

ProgressLine::ProgressLine(std::string label)
    : label_(std::move(label)), terminal_(isatty(STDERR_FILENO) != 0) {}

ProgressLine::~ProgressLine() {
    clear();
}

void ProgressLine::show(double share, const std::string& what) {
    const int percent = static_cast<int>(share * 100);
    if (!terminal_) {
        if (percent / 10 == shown_ / 10 && shown_ >= 0) return;
        shown_ = percent;
        say(fmt::format("{} {:3d} % {}\n", label_, percent, what));
        return;
    }
    constexpr int kBar = 24;
    const int full = percent * kBar / 100;
    std::string line =
        fmt::format("{} [{:<{}}] {:3d} % {}", label_, std::string(static_cast<size_t>(full), '#'),
                    kBar, percent, what);
    const size_t width = line.size();
    if (width < width_) line.append(width_ - width, ' ');
    width_ = width;
    say("\r" + line);
}

void ProgressLine::clear() {
    if (terminal_ && width_ > 0) say(fmt::format("\r{:{}}\r", "", width_));
    width_ = 0;
}

void print(const std::vector<Problem>& problems, std::FILE* to) {
    for (const Problem& problem : problems) fmt::print(to, "{}\n", problem.text());
}

namespace {

template <class Number>
CLI::Validator range(Number low, Number high, const char* kind) {
    const auto check = [=](const std::string& text) {
        Number value{};
        const char* const last = text.data() + text.size();
        const auto [end, status] = std::from_chars(text.data(), last, value);
        // the comparison also refuses NaN
        if (status == std::errc() && end == last && value >= low && value <= high)
            return std::string();
        return fmt::format("must be a {} from {} to {}, is '{}'", kind, low, high, text);
    };
    return {check, fmt::format("{} to {}", low, high)};
}

}  // namespace

CLI::Validator rate_range() {
    return range(100.0, 10000.0, "number");
}

CLI::Validator time_range() {
    return range(1.0, 3600.0, "number");
}

CLI::Validator seed_range() {
    return range(uint64_t{0}, std::numeric_limits<uint64_t>::max(), "whole number");
}

}  // namespace dihaptic::cli
