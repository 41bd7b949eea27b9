// A child is another program that this program starts and waits for. companion.h runs Dihaptic's
// own programs in this way, with limits on their time and memory.
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
    static constexpr int kKept = -2;     ///< the parent's file that has the same number
    /// The child neither ignores nor blocks any signal, not even those that the parent ignores or
    /// blocks.
    static constexpr short kFreshSignals = POSIX_SPAWN_SETSIGDEF | POSIX_SPAWN_SETSIGMASK;

    std::string program;  ///< a path, or a name to be looked up in PATH
    std::vector<std::string> arguments;
    /// The child's files 0, 1, 2 and so on: each is a descriptor of the parent, kNothing or kKept.
    /// The child inherits none of the parent's other files, which may be devices. The child's files
    /// are created in this order, so no descriptor may be smaller than the number that it gets in
    /// the child.
    std::vector<int> files;
    short flags = 0;  ///< for posix_spawnattr_setflags()
};

class Child {
  public:
    Child() = default;
    /// Kills the child if it is still running.
    ~Child();
    Child(const Child&) = delete;
    Child& operator=(const Child&) = delete;

    /// Starts the program. Returns 0 or an error number.
    int start(const Launch& launch);
    /// The child's process number; 0 if the child was not started or is known to have ended.
    pid_t process() const noexcept { return process_; }
    /// Whether the child has ended. Also true if it was never started.
    bool has_ended() noexcept { return reap(WNOHANG); }
    /// Waits until the child has ended. Returns the child's status in the form in which waitpid()
    /// gives it, or nullopt if the status is unknown.
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
