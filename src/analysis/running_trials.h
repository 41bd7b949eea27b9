// Reads a session that still runs, as far as its log has been written, for what is found of its
// trials: the figures that trials.csv will have.
#pragma once

#include <optional>

#include "analysis/session_report.h"
#include "recording/raw_log.h"
#include "recording/session.h"

namespace dihaptic::analysis {

class RunningTrials {
  public:
    /// Throws Error when the folder is of no session with the trials of a task.
    explicit RunningTrials(const std::string& folder);

    /// Reads what has been recorded since the last call. Throws Error when it cannot.
    void look();
    /// A row for each attempt so far; that of an attempt that goes on is not final.
    Table table() const;
    /// Number of attempts that have ended.
    size_t ended() const;

  private:
    recording::SessionFolder folder_;
    recording::SessionInfo info_;
    std::optional<recording::RawLogReader> log_;
    std::optional<SessionReader> reader_;
    std::optional<recording::ChunkPlace> last_;  // chunk that was read
};

}  // namespace dihaptic::analysis
