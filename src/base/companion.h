// The programs that lie beside this one and that it calls: what may crash, hang or fill the memory,
// or has to outlive it, runs in one of them.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "base/diagnostics.h"

namespace dihaptic {

/// Path of the companion `name`: it lies in the folder of the program that runs, or, for tests,
/// which run from folders below, in one above. "" when there is none.
std::string companion(const std::string& name);

/// What a companion may take before it is ended.
struct CompanionLimits {
    int processor_time = 10;    ///< [s]
    int time = 60;              ///< on the wall's clock, other programs' load included [s]
    uint64_t memory = 1 << 30;  ///< [bytes of address space]
    uint64_t output = 1 << 30;  ///< what it may write [bytes]
};

/// A piece of work that a companion does, and how its failures are told.
struct CompanionTask {
    std::string program;  ///< the companion's name
    std::vector<std::string> arguments;
    CompanionLimits limits;
    std::string what;    ///< e.g. "reading the mesh a.obj": "... took more than 2 s"
    std::string remedy;  ///< for input that it crashes on, or that takes more than the limits
    Place place;         ///< where the input was named
    std::string key;
};

/// Runs a companion: it reads `input` from its standard input, and what it writes to its standard
/// output is returned. Nothing when it refuses the input, by an exit status other than 0; 3 means
/// that memory did not suffice. Throws Error when it is missing, cannot be started, crashes, takes
/// more than its limits or is cancelled. Ends with the companion ended, whatever happens.
std::optional<std::string> run_companion(const CompanionTask& task, const std::string& input);

/// From any thread: each companion of that name that runs ends, and whoever waits for it gets an
/// Error. Does nothing when there is none.
void cancel_companions(const std::string& name) noexcept;

}  // namespace dihaptic
