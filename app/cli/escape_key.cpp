#include "escape_key.h"

#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <array>

namespace dihaptic::cli {
namespace {

constexpr char kEscape = 27;
constexpr int kWait = 20;  // time between checks whether the session is over [ms]

}  // namespace

EscapeKey::EscapeKey(std::atomic<bool>& pressed, ValueRing<char>& keys) {
    const bool ours = isatty(STDIN_FILENO) != 0 && tcgetpgrp(STDIN_FILENO) == getpgrp();
    if (!ours || tcgetattr(STDIN_FILENO, &before_) != 0) return;
    termios mode = before_;
    mode.c_lflag &= ~static_cast<tcflag_t>(ICANON | ECHO);
    mode.c_cc[VMIN] = 1;
    mode.c_cc[VTIME] = 0;
    if (tcsetattr(STDIN_FILENO, TCSANOW, &mode) != 0) return;
    listens_ = true;
    thread_ = std::thread([this, &pressed, &keys] { listen(pressed, keys); });
}

EscapeKey::~EscapeKey() {
    done_.store(true);
    if (thread_.joinable()) thread_.join();
    restore();
}

void EscapeKey::restore() noexcept {
    if (listens_) tcsetattr(STDIN_FILENO, TCSANOW, &before_);
}

void EscapeKey::listen(std::atomic<bool>& pressed, ValueRing<char>& keys) {
    while (!done_.load()) {
        pollfd input{STDIN_FILENO, POLLIN, 0};
        if (poll(&input, 1, kWait) <= 0) continue;
        std::array<char, 64> typed;
        const ssize_t count = read(STDIN_FILENO, typed.data(), typed.size());
        if (count <= 0) {
            pressed.store(true);  // the terminal was closed, so the operator has lost control
            return;
        }
        // the codes of arrow and function keys start with Escape, so they stop the session too,
        // which is harmless
        if (std::find(typed.begin(), typed.begin() + count, kEscape) != typed.begin() + count)
            pressed.store(true);
        else
            std::for_each(typed.begin(), typed.begin() + count, [&](char key) { keys.push(key); });
    }
}

}  // namespace dihaptic::cli
