// Companions are programs that are shipped with this one and called by it. Work that may crash,
// hang or fill the memory, or that has to outlive this program, runs in a companion.
#pragma once

#include <cstdint>
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include "base/diagnostics.h"

namespace dihaptic {

/// Path of the companion `name` (base/installed.h says where the program looks for it); "" if there
/// is none.
std::string companion(const std::string& name);

/// The remedy for a missing companion.
constexpr const char* kCompanionMissing = "Build all of Dihaptic, or install it again.";

/// Limits beyond which a companion is killed.
struct CompanionLimits {
    int processor_time = 10;  ///< [s]
    int time = 60;            ///< wall-clock time, which grows with the load of other programs [s]
    uint64_t memory = 1 << 30;  ///< address space [bytes]
    uint64_t output = 1 << 30;  ///< amount of output [bytes]
};

/// A piece of work for a companion, and the words for a report of its failure.
struct CompanionTask {
    std::string program;  ///< the companion's name
    std::vector<std::string> arguments;
    CompanionLimits limits;
    std::string what;  ///< description, e.g. "reading the mesh a.obj", for "... took more than 2 s"
    std::string remedy;  ///< the remedy for input that makes it crash or exceed its limits
    Place place;         ///< where the input's name was written
    std::string key;
    std::stop_token stop = {};  ///< ends the companion
};

/// Called by a thread that waits for a companion, after one second and again each time the waiting
/// time has doubled. `what` is CompanionTask::what; `most`: the time after which the companion is
/// killed [s]. With null, the default, nothing is called.
using CompanionWait = void (*)(const std::string& what, int seconds, int most);
void tell_companion_waits(CompanionWait tell) noexcept;

/// Runs a companion with `input` as its standard input, and returns its standard output.
/// Returns nullopt when it refuses the input, with an exit status other than 0; exit status 3 is an
/// error instead, and means that memory ran out. Throws Error when the companion is missing, cannot
/// be started, crashes, exceeds its limits or is stopped. The companion has ended whenever this
/// function returns or throws.
std::optional<std::string> run_companion(const CompanionTask& task, const std::string& input);

}  // namespace dihaptic
