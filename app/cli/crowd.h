// Work for many people, each in a process of its own, as many at a time as requested.
#pragma once

#include <sys/types.h>

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace dihaptic::cli {

struct CrowdWork {
    int jobs = 1;
    std::string out;  ///< folder, named in messages
    /// Starts a person's process; returns nullopt if another program is already doing this person's
    /// work.
    std::function<std::optional<pid_t>(const std::string& id)> start;
    std::function<bool(const std::string& id)> is_done;
    /// The message that a person's process left.
    std::function<std::string(const std::string& id)> messages;
};

/// Starts a process that does `work` and ends with its result. It is a copy of this process
/// and of everything it has read, so that the others continue if one fails.
pid_t start_process(const std::function<int()>& work);

/// Does the work for all people, and shows the progress. Returns the text about people whose work
/// failed, and sets the exit code if there are any.
std::vector<std::string> run_crowd(const CrowdWork& work, const std::vector<std::string>& people);

}  // namespace dihaptic::cli
