#include "host/at_death.h"

#include <unistd.h>

#include <array>
#include <atomic>
#include <csignal>
#include <cstring>

#include "host/force_off.h"

namespace dihaptic::host {
namespace {

/// Async-signal-safe.
void say(const char* text) {
    [[maybe_unused]] const ssize_t written = write(STDERR_FILENO, text, std::strlen(text));
}

void on_error(int signal) {
    static std::atomic_flag dying = ATOMIC_FLAG_INIT;
    if (!dying.test_and_set()) {
        const bool off = force_off_now();
        say("\nerror: the program failed (SIG");
        const char* const name = sigabbrev_np(signal);
        say(name == nullptr ? "?" : name);
        say(off ? "). Force is off."
                : "). Force could not be taken away: switch off the devices' power.");
        say(" A session's data so far are kept: dihaptic recover SESSION. Please report this, with"
            " the session's folder.\n");
    }
    std::signal(signal, SIG_DFL);
    raise(signal);
}

}  // namespace

void take_force_away_at_death() {
    // the handler needs its own stack, because an overflow of the main thread's stack leaves no
    // room
    static std::array<char, 65536> stack;
    stack_t own{};
    own.ss_sp = stack.data();
    own.ss_size = stack.size();
    sigaltstack(&own, nullptr);
    struct sigaction action {};
    action.sa_handler = on_error;
    action.sa_flags = SA_ONSTACK | SA_NODEFER;
    sigemptyset(&action.sa_mask);
    for (const int signal : kErrors) sigaction(signal, &action, nullptr);
}

}  // namespace dihaptic::host
