// A child is another program that this one starts and waits for. companion.h runs programs of ours
// under limits.
#pragma once

#include <spawn.h>
#include <sys/wait.h>

#include <optional>
#include <string>
#include <vector>

namespace dihaptic {

/// How to start a child.
struct Launch {
    static constexpr int kNothing = -1;  ///< /dev/null
    static constexpr int kKept = -2;     ///< the file that has this number here
    /// The child ignores and blocks no signals, not even those that are ignored or blocked here.
    static constexpr short kFreshSignals = POSIX_SPAWN_SETSIGDEF | POSIX_SPAWN_SETSIGMASK;

    std::string program;  ///< a path, or a name to be found in PATH
    std::vector<std::string> arguments;
    /// The child's files 0, 1, 2 and so on: each a descriptor of ours, kNothing or kKept. It gets
    /// none of our other files, which may be devices. The child's files are made in this order, so
    /// no descriptor may be smaller than its number in the child.
    std::vector<int> files;
    short flags = 0;  ///< for posix_spawnattr_setflags()
};

class Child {
  public:
    Child() = default;
    /// Kills the child, unless it has ended.
    ~Child();
    Child(const Child&) = delete;
    Child& operator=(const Child&) = delete;

    /// Returns 0 or an error number.
    int start(const Launch& launch);
    /// The child's process number; 0 if it was not started, or is known to have ended.
    pid_t process() const noexcept { return process_; }
    /// Also true if the child was not started.
    bool has_ended() noexcept { return reap(WNOHANG); }
    /// Waits until the child has ended. Returns its status, as waitpid() does; nullopt if that is
    /// unknown.
    std::optional<int> wait() noexcept {
        reap(0);
        return status_;
    }

  private:
    bool reap(int options) noexcept;

    pid_t process_ = 0;
    std::optional<int> status_;
};

}  // namespace dihaptic
