#include "crowd.h"

#include <fmt/format.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <map>

#include "base/shell_word.h"
#include "common/console.h"

namespace dihaptic::cli {
namespace {

std::string what_became(int status) {
    return WIFSIGNALED(status) ? fmt::format("killed by signal {}", WTERMSIG(status)) : "failed";
}

/// The error message of a person's process that failed. A process that fails because the disk is
/// full leaves no message.
std::string why_failed(const CrowdWork& work, const std::string& id) {
    const std::string messages = work.messages(id);
    if (!messages.empty()) return messages;
    return fmt::format("It left no message: check whether the disk is full (df -h {}).",
                       shell_file(work.out));
}

/// Runs the processes of all people, at most as many at a time as requested.
class Crowd {
  public:
    Crowd(const CrowdWork& work, const std::vector<std::string>& people)
        : work_(work), people_(people), line_("rehearsing") {}

    /// Returns one text for each person whose session failed.
    std::vector<std::string> run() {
        while (!running_.empty() || (next_ < people_.size() && !stop_requested)) {
            while (static_cast<int>(running_.size()) < work_.jobs && next_ < people_.size() &&
                   !stop_requested) {
                begin(people_[next_++]);
            }
            if (!running_.empty()) wait();
        }
        for (const std::string& id : busy_) look_again(id);
        if (done_ < people_.size()) exit_code = kFailed;
        if (stop_requested)
            failed_.push_back(
                fmt::format("interrupted after {} of {} people", done_, people_.size()));
        return std::move(failed_);
    }

  private:
    void begin(const std::string& id) {
        try {
            if (const auto process = work_.start(id)) {
                running_[*process] = id;
                return;
            }
            busy_.push_back(id);
        } catch (const Error& e) {
            fail(id, "failed", e.what());
        }
    }
    /// Checks again a person whose turn was skipped: another program may have done the work
    /// meanwhile.
    void look_again(const std::string& id) {
        try {
            if (work_.is_done(id)) {
                ++done_;
                return show();
            }
            fail(id, "failed",
                 "Another dihaptic is doing this session now: wait until it has ended.");
        } catch (const Error& e) {
            fail(id, "failed", e.what());
        }
    }
    void wait() {
        int status = 0;
        const pid_t child = waitpid(-1, &status, 0);
        if (child < 0 && errno == EINTR) return;
        if (child < 0) {
            throw Error({work_.out, 0}, "",
                        "is not supervised: " + std::string(std::strerror(errno)),
                        "Start it again: it continues with the missing people.");
        }
        const auto ended = running_.find(child);
        if (ended == running_.end()) return;
        const std::string id = ended->second;
        running_.erase(ended);
        if (status == 0) {
            ++done_;
            show();
        } else if (!stop_requested || WIFSIGNALED(status)) {
            fail(id, what_became(status), why_failed(work_, id));
        }
    }
    void fail(const std::string& id, const std::string& what, const std::string& why) {
        failed_.push_back(fmt::format("{}: {}. {}", id, what, why));
        show();
    }
    void show() {
        line_.show(
            static_cast<double>(done_ + failed_.size()) / static_cast<double>(people_.size()),
            fmt::format("{} of {}", done_, people_.size()));
    }

    const CrowdWork& work_;
    const std::vector<std::string>& people_;
    ProgressLine line_;
    std::map<pid_t, std::string> running_;
    std::vector<std::string> busy_;  ///< people whose work another program was doing at their turn
    std::vector<std::string> failed_;
    size_t next_ = 0;
    size_t done_ = 0;
};

}  // namespace

pid_t start_process(const std::function<int()>& work) {
    std::fflush(nullptr);
    const pid_t child = fork();
    if (child == 0) {
        const int code = work();
        std::fflush(nullptr);
        _exit(code);
    }
    if (child < 0) {
        throw Error(fmt::format("cannot start another process: {}", std::strerror(errno)),
                    "Use fewer --jobs.");
    }
    return child;
}

std::vector<std::string> run_crowd(const CrowdWork& work, const std::vector<std::string>& people) {
    return Crowd(work, people).run();
}

}  // namespace dihaptic::cli
