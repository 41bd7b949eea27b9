// Starts and restarts the shards of a rehearsal: as a Slurm job array, by GNU parallel, or
// individually by hand.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "session/rehearsal.h"

namespace dihaptic::cli {

/// Path of the shell script for sbatch in a rehearsal's folder; each shard is a task of its array.
std::string slurm_script(const std::string& folder);
/// Writes the script, unless there is already one for the same shards, perhaps with added lines.
void write_slurm_script(const std::string& folder, const session::Asked& asked);

/// Submits these shards to Slurm. Returns the number of the job; nullopt when sbatch is missing or
/// refuses, after printing this and the command to type.
std::optional<std::string> submit(const std::string& folder, const session::Asked& asked,
                                  const std::vector<int>& shards);

/// The command that runs these shards: with sbatch, if the folder's script is for them.
std::string command_for(const std::string& folder, const session::Asked& asked,
                        const std::vector<int>& shards);

}  // namespace dihaptic::cli
