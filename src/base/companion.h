// Companions are programs that are shipped with this program and started by it. Work that may
// crash, hang or use up the memory, or that has to outlive this program, is done by a companion.
#pragma once

#include <cstdint>
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include "base/diagnostics.h"

namespace dihaptic {

/// Path of the companion `name`; "" if there is none. The folders searched are described in
/// base/installed.h.
std::string companion(const std::string& name);

/// The remedy for a missing companion.
constexpr const char* kCompanionMissing = "Build all of Dihaptic, or install it again.";

/// Limits on a companion's resources; a companion that exceeds one is killed.
struct CompanionLimits {
    int processor_time = 10;    ///< [s]
    int time = 60;              ///< wall-clock time, which depends on the load of the machine [s]
    uint64_t memory = 1 << 30;  ///< address space [bytes]
    uint64_t output = 1 << 30;  ///< amount of output [bytes]
};

/// A task for a companion, and the words with which its failure is reported.
struct CompanionTask {
    std::string program;  ///< the companion's name
    std::vector<std::string> arguments;
    CompanionLimits limits;
    std::string what;  ///< description, e.g. "reading the mesh a.obj", for "... took more than 2 s"
    std::string remedy;  ///< remedy for input that makes the companion crash or exceed its limits
    Place place;         ///< where the name of the input was written
    std::string key;
    std::stop_token stop = {};  ///< a stop request ends the companion
};

/// Called by a thread that is waiting for a companion, first after one second and then each time
/// the waiting time has doubled. `what` is CompanionTask::what; `most` is the time after which the
/// companion is killed [s]. If the function is null, which is the default, nothing is called.
using CompanionWait = void (*)(const std::string& what, int seconds, int most);
void tell_companion_waits(CompanionWait tell) noexcept;

/// Runs a companion with `input` as its standard input, and returns its standard output. Returns
/// nullopt if the companion refuses the input, i.e. ends with an exit status other than 0 and 3.
/// Exit status 3 means that memory ran out, which is an error. Throws Error if the companion is
/// missing, cannot be started, crashes, runs out of memory, exceeds its limits or is stopped.
/// Whether this function returns or throws, the companion has ended by then.
std::optional<std::string> run_companion(const CompanionTask& task, const std::string& input);

}  // namespace dihaptic
