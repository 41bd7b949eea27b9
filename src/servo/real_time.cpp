#include "servo/real_time.h"

#include <alloca.h>
#include <fcntl.h>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <pthread.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <thread>
#include <vector>

namespace dihaptic::servo {
namespace {

constexpr const char* kAwake = "/dev/cpu_dma_latency";

int ask_priority(int priority) {
    // to save power, the kernel may wake ordinary threads 50 us late; matters if FIFO is refused
    prctl(PR_SET_TIMERSLACK, 1UL, 0, 0, 0);
    sched_param wanted{};
    wanted.sched_priority = priority;
    return pthread_setschedparam(pthread_self(), SCHED_FIFO, &wanted);
}

int ask_memory() {
    // If locked memory is limited, lock only the memory in use: with MCL_FUTURE, later memory
    // requests by other threads would fail altogether.
    rlimit limit{};
    const bool free = getrlimit(RLIMIT_MEMLOCK, &limit) == 0 && limit.rlim_cur == RLIM_INFINITY;
    return mlockall(free ? MCL_CURRENT | MCL_FUTURE : MCL_CURRENT) == 0 ? 0 : errno;
}

int ask_awake(Descriptor& file) {
    file = Descriptor(open(kAwake, O_WRONLY | O_CLOEXEC));
    // the file is absent if the kernel does not manage sleep states, as in containers and virtual
    // machines
    if (!file) return errno == ENOENT ? 0 : errno;
    const int32_t most_us = 0;
    return write(file.get(), &most_us, sizeof most_us) == sizeof most_us ? 0 : errno;
}

/// Free space on this thread's stack [bytes]; a small limit may have been set with `ulimit -s`.
size_t room_on_stack() {
    pthread_attr_t thread;
    if (pthread_getattr_np(pthread_self(), &thread) != 0) return 0;
    void* lowest = nullptr;
    size_t size = 0;
    pthread_attr_getstack(&thread, &lowest, &size);
    pthread_attr_destroy(&thread);
    const char here = 0;
    return static_cast<size_t>(&here - static_cast<char*>(lowest));
}

/// Touches the stack in advance, because the first access to a page during a tick would cause a
/// page fault.
void touch_stack() {
    const size_t size = std::min<size_t>(262144, room_on_stack() / 2);
    auto* const stack = static_cast<volatile char*>(alloca(size));
    for (size_t i = 0; i < size; i += 1024) stack[i] = 0;
}

}  // namespace

RealTime::RealTime(int priority) {
    refusals_.memory = ask_memory();
    refusals_.awake = ask_awake(awake_);
    touch_stack();
    // priority is requested last: the steps above take milliseconds, during which this thread would
    // otherwise keep other programs waiting
    refusals_.priority = ask_priority(priority);
}

RealTime::~RealTime() {
    const sched_param ordinary{};
    pthread_setschedparam(pthread_self(), SCHED_OTHER, &ordinary);
    if (refusals_.memory == 0) munlockall();
}

std::string describe(const RealTime::Refusals& refusals, int priority, bool root) {
    std::vector<std::string> refused;
    const auto note = [&](int error, const std::string& what) {
        if (error != 0) refused.push_back(fmt::format("{} ({})", what, strerrorname_np(error)));
    };
    note(refusals.priority, fmt::format("priority {}", priority));
    note(refusals.memory, "locked memory");
    note(refusals.awake, "wakeful processors");
    if (refused.empty()) return "";
    return fmt::format("real time: Linux refused {}, so ticks may come late; dihaptic doctor {}",
                       fmt::join(refused, ", "),
                       root ? "shows how to start a container with these permissions"
                            : "gives the commands that allow it");
}

std::string describe(const RealTime::Refusals& refusals, int priority) {
    return describe(refusals, priority, geteuid() == 0);
}

RealTime::Refusals try_real_time(int priority) {
    RealTime::Refusals refusals;
    std::thread([&] { refusals = RealTime(priority).refusals(); }).join();
    return refusals;
}

}  // namespace dihaptic::servo
