#include "common/stop_signals.h"

#include <unistd.h>

#include <array>
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
    // if the pipe is full, its reader has already been woken up
    [[maybe_unused]] const ssize_t written = write(wake_file.load(), &number, 1);
    errno = before;
}

struct sigaction done_at(int signal) {
    struct sigaction now {};
    sigaction(signal, nullptr, &now);
    return now;
}

void handle(int signal, void (*handler)(int)) {
    struct sigaction action {};
    action.sa_handler = handler;
    action.sa_flags = SA_RESTART;
    sigfillset(&action.sa_mask);
    sigaction(signal, &action, nullptr);
}

constexpr std::initializer_list<int> kEnding = {SIGINT,    SIGTERM, SIGHUP,  SIGQUIT, SIGUSR1,
                                                SIGUSR2,   SIGALRM, SIGXCPU, SIGPOLL, SIGVTALRM,
                                                SIGSTKFLT, SIGPROF, SIGPWR};
constexpr std::array kSuspending{SIGTSTP, SIGTTIN, SIGTTOU};

}  // namespace

void stop_on_signals(std::atomic<bool>& stop, int wake) {
    wake_file.store(wake);
    flag.store(&stop);
    for (const int signal : kEnding) {
        const struct sigaction before = done_at(signal);
        const bool nohup = signal == SIGHUP && before.sa_handler == SIG_IGN;
        const bool anothers = (before.sa_flags & SA_SIGINFO) != 0 ||
                              (before.sa_handler != SIG_IGN && before.sa_handler != SIG_DFL);
        if (!nohup && !anothers) handle(signal, on_signal);  // keeps e.g. a profiler's handler
    }
    // writing to a pipe without a reader, or beyond a size limit, then returns an error instead
    handle(SIGPIPE, SIG_IGN);
    handle(SIGXFSZ, SIG_IGN);
}

NoSuspension::NoSuspension() {
    for (size_t i = 0; i < kSuspending.size(); ++i) {
        before_[i] = done_at(kSuspending[i]);
        handle(kSuspending[i], on_signal);
    }
}

NoSuspension::~NoSuspension() {
    for (size_t i = 0; i < kSuspending.size(); ++i) sigaction(kSuspending[i], &before_[i], nullptr);
}

}  // namespace dihaptic::app
