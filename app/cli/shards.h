// Starts and restarts the shards of a rehearsal: as a Slurm job array, with GNU parallel, or one by
// one by hand.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "session/rehearsal.h"

namespace dihaptic::cli {

/// Path of the sbatch script in a rehearsal folder; each shard is a task of the script's job array.
std::string slurm_script(const std::string& folder);
/// Writes the sbatch script, unless the folder already contains a script for the same shards,
/// possibly with added lines.
void write_slurm_script(const std::string& folder, const session::Asked& asked);

/// Submits the given shards to Slurm. Returns the job number. If sbatch is missing or refuses,
/// prints the reason and the command to type, and returns nullopt.
std::optional<std::string> submit(const std::string& folder, const session::Asked& asked,
                                  const std::vector<int>& shards);

/// The command that runs the given shards: with sbatch, if the folder contains a script for them.
std::string command_for(const std::string& folder, const session::Asked& asked,
                        const std::vector<int>& shards);

}  // namespace dihaptic::cli
