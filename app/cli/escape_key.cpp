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

EscapeKey::EscapeKey(std::atomic<bool>& pressed, std::atomic<char>& key) {
    const bool ours = isatty(STDIN_FILENO) != 0 && tcgetpgrp(STDIN_FILENO) == getpgrp();
    if (!ours || tcgetattr(STDIN_FILENO, &before_) != 0) return;
    termios keys = before_;
    keys.c_lflag &= ~static_cast<tcflag_t>(ICANON | ECHO);
    keys.c_cc[VMIN] = 1;
    keys.c_cc[VTIME] = 0;
    if (tcsetattr(STDIN_FILENO, TCSANOW, &keys) != 0) return;
    listens_ = true;
    thread_ = std::thread([this, &pressed, &key] { listen(pressed, key); });
}

EscapeKey::~EscapeKey() {
    done_.store(true);
    if (thread_.joinable()) thread_.join();
    restore();
}

void EscapeKey::restore() noexcept {
    if (listens_) tcsetattr(STDIN_FILENO, TCSANOW, &before_);
}

void EscapeKey::listen(std::atomic<bool>& pressed, std::atomic<char>& key) {
    while (!done_.load()) {
        pollfd input{STDIN_FILENO, POLLIN, 0};
        if (poll(&input, 1, kWait) <= 0) continue;
        std::array<char, 64> keys;
        const ssize_t count = read(STDIN_FILENO, keys.data(), keys.size());
        if (count <= 0) {
            pressed.store(true);  // the terminal is closed, and the operator has no more control
            return;
        }
        // arrows and function keys start with Escape, so they stop the session too, which is
        // harmless
        if (std::find(keys.begin(), keys.begin() + count, kEscape) != keys.begin() + count)
            pressed.store(true);
        else
            key.store(keys[static_cast<size_t>(count - 1)]);
    }
}

}  // namespace dihaptic::cli
