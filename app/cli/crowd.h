// Work for many people, each in a separate process, at most as many at a time as requested.
#pragma once

#include <sys/types.h>

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace dihaptic::cli {

struct CrowdWork {
    int jobs = 1;
    std::string out;  ///< output folder, named in messages
    /// Starts a person's process; returns nullopt if another program is already doing this person's
    /// work.
    std::function<std::optional<pid_t>(const std::string& id)> start;
    std::function<bool(const std::string& id)> is_done;
    /// Returns the error message that a person's process left.
    std::function<std::string(const std::string& id)> messages;
};

/// Starts a process that does `work` and exits with its result. The process is a copy of this one,
/// including everything that has been read, so a failure does not affect the other processes.
pid_t start_process(const std::function<int()>& work);

/// Does the work for all people, and shows the progress. Returns one text for each person whose
/// work failed, and sets the exit code if there are any.
std::vector<std::string> run_crowd(const CrowdWork& work, const std::vector<std::string>& people);

}  // namespace dihaptic::cli
