#include "base/companion.h"

#include <fmt/format.h>
#include <poll.h>
#include <signal.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <cstring>

#include "base/child.h"
#include "base/descriptor.h"
#include "base/installed.h"

namespace dihaptic {
namespace {

constexpr int kOutOfMemory = 3;  // exit status

/// A file that exists only in memory, without a name or a folder.
class MemoryFile {
  public:
    explicit MemoryFile(const std::string& text)
        : descriptor_(memfd_create("dihaptic", MFD_CLOEXEC)) {
        good_ = static_cast<bool>(descriptor_);
        for (size_t at = 0; good_ && at < text.size();) {
            const ssize_t size = write(descriptor_.get(), text.data() + at, text.size() - at);
            good_ = size > 0;
            if (good_) at += static_cast<size_t>(size);
        }
        good_ = good_ && lseek(descriptor_.get(), 0, SEEK_SET) == 0;
    }

    bool good() const { return good_; }
    int descriptor() const { return descriptor_.get(); }
    std::string text() const {
        struct stat about {};
        if (fstat(descriptor_.get(), &about) != 0) return "";
        std::string out(static_cast<size_t>(about.st_size), '\0');
        for (size_t at = 0; at < out.size();) {
            const ssize_t size =
                pread(descriptor_.get(), out.data() + at, out.size() - at, static_cast<off_t>(at));
            if (size <= 0) return "";
            at += static_cast<size_t>(size);
        }
        return out;
    }

  private:
    Descriptor descriptor_;
    bool good_ = false;
};

bool limit(pid_t process, const CompanionLimits& limits) {
    const auto set = [&](__rlimit_resource which, uint64_t soft, uint64_t hard) {
        rlimit now{};
        // the process is gone
        if (prlimit(process, which, nullptr, &now) != 0) return errno == ESRCH;
        // a process whose hard limit is already lower cannot be given a higher one
        const rlimit value{std::min(soft, now.rlim_max), std::min(hard, now.rlim_max)};
        return prlimit(process, which, &value, nullptr) == 0 || errno == ESRCH;
    };
    const auto seconds = static_cast<uint64_t>(limits.processor_time);
    return set(RLIMIT_CPU, seconds, seconds + 1) && set(RLIMIT_AS, limits.memory, limits.memory) &&
           set(RLIMIT_FSIZE, limits.output, limits.output) && set(RLIMIT_CORE, 0, 0);
}

std::atomic<CompanionWait> told_of_waits{nullptr};

/// Waits until a process has ended, without reaping it; false if that takes longer than the
/// task's time limit.
bool wait_for(pid_t process, const CompanionTask& task) {
    using Clock = std::chrono::steady_clock;
    const auto begin = Clock::now();
    const auto end = begin + std::chrono::seconds(task.limits.time);
    auto tell = std::chrono::seconds(1);
    const Descriptor watch(static_cast<int>(syscall(SYS_pidfd_open, process, 0)));
    if (!watch) return false;
    pollfd ended{watch.get(), POLLIN, 0};
    int ready = 0;
    do {
        const auto until = std::min(end, begin + tell);
        const auto left =
            std::chrono::ceil<std::chrono::milliseconds>(until - Clock::now()).count();
        ready = poll(&ended, 1, static_cast<int>(std::max<int64_t>(left, 0)));
        if (ready != 0 || until == end) continue;
        if (const CompanionWait told = told_of_waits; told != nullptr)
            told(task.what, static_cast<int>(tell.count()), task.limits.time);
        tell *= 2;
    } while (ready == 0 ? Clock::now() < end : ready < 0 && errno == EINTR);
    return ready > 0;
}

struct Ended {
    int status = 1 << 8;  // an unknown status is treated as if the companion had refused its input
    bool late = false;
};

Ended run(const CompanionTask& task, const std::string& path, int in, int out) {
    const auto failed = [&](int error) {
        return Error(task.place, task.key,
                     fmt::format("the program {}, which is for {}, cannot be run: {}", task.program,
                                 task.what, std::strerror(error)),
                     "End other programs and try again.");
    };
    Child child;
    const int error =
        child.start({path, task.arguments, {in, out, Launch::kNothing}, Launch::kFreshSignals});
    if (error != 0) throw failed(error);
    const pid_t process = child.process();
    const bool limited = limit(process, task.limits);
    Ended ended;
    {
        const std::stop_callback stopped(task.stop, [process] { kill(process, SIGTERM); });
        if (limited) ended.late = !wait_for(process, task);
        if (!limited || ended.late) kill(process, SIGKILL);
        siginfo_t ignored{};
        while (waitid(P_PID, static_cast<id_t>(process), &ignored, WEXITED | WNOWAIT) < 0 &&
               errno == EINTR)
            continue;
    }
    // the process is reaped only here, because its PID may be reused from this point on
    if (const auto status = child.wait()) ended.status = *status;
    if (!limited) throw failed(EPERM);
    return ended;
}

/// Why the companion ended early; "" if it did not.
std::string failure(const CompanionTask& task, const Ended& ended) {
    const int status = ended.status;
    const int signal = WIFSIGNALED(status) ? WTERMSIG(status) : 0;
    if (ended.late) return fmt::format("took more than {} s", task.limits.time);
    if (signal == SIGXCPU)
        return fmt::format("took more than {} s of computing time", task.limits.processor_time);
    if (signal == SIGXFSZ)
        return fmt::format("wrote more than {} MB", task.limits.output / 1'000'000);
    // the kernel kills a process that uses up the machine's memory
    if (signal == SIGKILL || (WIFEXITED(status) && WEXITSTATUS(status) == kOutOfMemory))
        return fmt::format("took more than {} MB of memory", task.limits.memory / 1'000'000);
    if (signal != 0) return fmt::format("failed: {} crashed ({})", task.program, strsignal(signal));
    return "";
}

}  // namespace

void tell_companion_waits(CompanionWait tell) noexcept {
    told_of_waits = tell;
}

std::string companion(const std::string& name) {
    return in_or_above_program({name, "libexec/dihaptic/" + name});
}

std::optional<std::string> run_companion(const CompanionTask& task, const std::string& input) {
    const std::string path = companion(task.program);
    if (path.empty()) {
        throw Error(
            task.place, task.key,
            fmt::format("the program {}, which is for {}, is missing", task.program, task.what),
            kCompanionMissing);
    }
    const MemoryFile in(input);
    const MemoryFile out("");
    if (!in.good() || !out.good()) {
        throw Error(task.place, task.key,
                    fmt::format("there is no memory for {}: {}", task.what, std::strerror(errno)),
                    "End other programs and try again.");
    }
    const Ended ended = run(task, path, in.descriptor(), out.descriptor());
    if (WIFEXITED(ended.status) && WEXITSTATUS(ended.status) == 0) return out.text();
    const int signal = WIFSIGNALED(ended.status) ? WTERMSIG(ended.status) : 0;
    if (signal == SIGTERM || signal == SIGINT || signal == SIGHUP) {
        throw Error(task.place, task.key, task.what + " was cancelled", "Open the file again.");
    }
    if (const std::string why = failure(task, ended); !why.empty())
        throw Error(task.place, task.key, task.what + " " + why, task.remedy);
    return std::nullopt;
}

}  // namespace dihaptic
