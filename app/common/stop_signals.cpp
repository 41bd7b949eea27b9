#include "common/stop_signals.h"

#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <initializer_list>

namespace dihaptic::app {
namespace {

std::atomic<std::atomic<bool>*> flag{nullptr};
std::atomic<int> wake_file{-1};

void on_signal(int signal) {
    const int before = errno;
    if (std::atomic<bool>* const stop = flag.load(); stop != nullptr) stop->store(true);
    const auto number = static_cast<char>(signal);
    // a full pipe has woken whoever reads it already
    [[maybe_unused]] const ssize_t written = write(wake_file.load(), &number, 1);
    errno = before;
}

using Handler = void (*)(int);

/// Returns what was done at it before.
Handler handle(int signal, Handler handler) {
    struct sigaction action {};
    struct sigaction before {};
    action.sa_handler = handler;
    action.sa_flags = SA_RESTART;
    sigfillset(&action.sa_mask);
    sigaction(signal, &action, &before);
    return before.sa_handler;
}

constexpr std::initializer_list<int> kEnding = {SIGINT,    SIGTERM, SIGHUP,  SIGQUIT, SIGUSR1,
                                                SIGUSR2,   SIGALRM, SIGXCPU, SIGPOLL, SIGVTALRM,
                                                SIGSTKFLT, SIGPROF, SIGPWR};
constexpr std::initializer_list<int> kSuspending = {SIGTSTP, SIGTTIN, SIGTTOU};

}  // namespace

void stop_on_signals(std::atomic<bool>& stop, int wake) {
    wake_file.store(wake);
    flag.store(&stop);
    for (const int signal : kEnding) {
        const Handler before = handle(signal, on_signal);
        const bool nohup = signal == SIGHUP && before == SIG_IGN;
        const bool anothers = before != SIG_IGN && before != SIG_DFL;  // a profiler's
        if (nohup || anothers) handle(signal, before);
    }
    // writing fails then, and says so: to a pipe that nobody reads, beyond a quota
    handle(SIGPIPE, SIG_IGN);
    handle(SIGXFSZ, SIG_IGN);
}

NoSuspension::NoSuspension() {
    for (const int signal : kSuspending) handle(signal, on_signal);
}

NoSuspension::~NoSuspension() {
    for (const int signal : kSuspending) handle(signal, SIG_DFL);
}

}  // namespace dihaptic::app
