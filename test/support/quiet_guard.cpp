#include "quiet_guard.h"

#include <dlfcn.h>
#include <pthread.h>
#include <semaphore.h>

#include <cstdlib>

#if defined(__x86_64__) && defined(__linux__) && !defined(DIHAPTIC_SANITIZED)
#define DIHAPTIC_CAN_TELL_QUIET
#endif

namespace {

thread_local size_t locks_taken = 0;
thread_local size_t thrown_count = 0;
thread_local int armed = 0;

}  // namespace

#ifdef DIHAPTIC_CAN_TELL_QUIET

#include <linux/filter.h>
#include <linux/seccomp.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <ucontext.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstddef>
#include <new>
#include <typeinfo>

namespace {

/// The C library's function, which one of those below replaces.
template <class Function>
Function real(const char* name) {
    return reinterpret_cast<Function>(dlsym(RTLD_NEXT, name));
}

void count_lock() {
    if (armed > 0) ++locks_taken;
}

}  // namespace

#define DIHAPTIC_COUNTED(name, parameters, arguments)            \
    int name parameters {                                        \
        static const auto call = real<int(*) parameters>(#name); \
        count_lock();                                            \
        return call arguments;                                   \
    }

extern "C" {

DIHAPTIC_COUNTED(pthread_mutex_lock, (pthread_mutex_t * m), (m))
DIHAPTIC_COUNTED(pthread_mutex_trylock, (pthread_mutex_t * m), (m))
DIHAPTIC_COUNTED(pthread_rwlock_rdlock, (pthread_rwlock_t * l), (l))
DIHAPTIC_COUNTED(pthread_rwlock_wrlock, (pthread_rwlock_t * l), (l))
DIHAPTIC_COUNTED(pthread_cond_signal, (pthread_cond_t * c), (c))
DIHAPTIC_COUNTED(pthread_cond_broadcast, (pthread_cond_t * c), (c))
DIHAPTIC_COUNTED(pthread_cond_wait, (pthread_cond_t * c, pthread_mutex_t* m), (c, m))
DIHAPTIC_COUNTED(sem_wait, (sem_t * s), (s))
DIHAPTIC_COUNTED(sem_post, (sem_t * s), (s))

[[noreturn]] void __cxa_throw(void* thrown, std::type_info* type, void (*destroy)(void*)) {
    using Throw = void (*)(void*, std::type_info*, void (*)(void*));
    static const auto call = real<Throw>("__cxa_throw");
    if (armed > 0) ++thrown_count;
    call(thrown, type, destroy);
    std::abort();
}

}  // extern "C"

namespace {

/// Counts, in memory that the watched process shares with this one.
struct Counts {
    std::array<int, 512> of;
};
Counts* shared = nullptr;

/// Handles the signal that the kernel sends in place of a system call.
void on_call(int, siginfo_t* info, void* context) {
    const auto number = static_cast<size_t>(info->si_syscall);
    ++shared->of[number % shared->of.size()];
    static_cast<ucontext_t*>(context)->uc_mcontext.gregs[REG_RAX] = -ENOSYS;
}

/// From here on every system call of this process becomes a signal, except those that end it or
/// return from the signal.
bool forbid_calls() {
    struct sigaction action {};
    action.sa_sigaction = on_call;
    action.sa_flags = SA_SIGINFO | SA_NODEFER;
    if (sigaction(SIGSYS, &action, nullptr) != 0) return false;
    std::array<sock_filter, 5> filter{{
        BPF_STMT(BPF_LD | BPF_W | BPF_ABS, offsetof(seccomp_data, nr)),
        BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, SYS_rt_sigreturn, 2, 0),
        BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, SYS_exit_group, 1, 0),
        BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_TRAP),
        BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ALLOW),
    }};
    const sock_fprog program{static_cast<unsigned short>(filter.size()), filter.data()};
    return prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) == 0 &&
           prctl(PR_SET_SECCOMP, SECCOMP_MODE_FILTER, &program) == 0;
}

constexpr int kRefused = 3;

}  // namespace

#endif

namespace dihaptic::testing {

QuietGuard::QuietGuard() {
    locks_taken = thrown_count = 0;
    ++armed;
}
QuietGuard::~QuietGuard() {
    --armed;
}
size_t QuietGuard::locks() const {
    return locks_taken;
}
size_t QuietGuard::throws() const {
    return thrown_count;
}

#ifdef DIHAPTIC_CAN_TELL_QUIET

bool can_tell_quiet() {
    return true;
}

SystemCalls system_calls(const std::function<void()>& run) {
    SystemCalls out;
    void* memory =
        mmap(nullptr, sizeof(Counts), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    if (memory == MAP_FAILED) {
        out.ended = "no memory to share";
        return out;
    }
    shared = new (memory) Counts{};
    const pid_t child = fork();
    if (child == 0) {
        if (!forbid_calls()) _exit(kRefused);
        run();
        _exit(0);
    }
    int status = 0;
    if (child < 0 || waitpid(child, &status, 0) != child) {
        out.ended = "no process";
    } else if (WIFSIGNALED(status)) {
        out.ended = "killed by signal " + std::to_string(WTERMSIG(status));
    } else if (WEXITSTATUS(status) == kRefused) {
        out.ended = "seccomp was refused";
    }
    for (size_t i = 0; i < shared->of.size(); ++i) {
        if (shared->of[i] > 0) out.count[static_cast<long>(i)] = shared->of[i];
    }
    munmap(memory, sizeof(Counts));
    return out;
}

#else

bool can_tell_quiet() {
    return false;
}
SystemCalls system_calls(const std::function<void()>&) {
    return {{}, "not in this build"};
}

#endif

}  // namespace dihaptic::testing
