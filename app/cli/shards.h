// How the shards of a rehearsal are started, and started again: as a Slurm job array, by GNU
// parallel, or each by hand.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "session/rehearsal.h"

namespace dihaptic::cli {

/// The shell script for sbatch in a rehearsal's folder: a task of the array for each shard.
std::string slurm_script(const std::string& folder);
/// Writes it, unless there is already one for the same shards, to which somebody may have added
/// lines.
void write_slurm_script(const std::string& folder, const session::Asked& asked);

/// Submits these shards to Slurm. Returns the number of the job; nullopt when there is no sbatch or
/// it refuses, after printing this and what to type.
std::optional<std::string> submit(const std::string& folder, const session::Asked& asked,
                                  const std::vector<int>& shards);

/// What to type so that these shards are done: by sbatch, if the folder's script is for them.
std::string command_for(const std::string& folder, const session::Asked& asked,
                        const std::vector<int>& shards);

}  // namespace dihaptic::cli
