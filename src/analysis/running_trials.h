// Reads what has been written of a running session's log, to find the results of its trials: the
// figures that trials.csv will contain.
#pragma once

#include <optional>

#include "analysis/session_report.h"
#include "recording/raw_log.h"
#include "recording/session.h"

namespace dihaptic::analysis {

class RunningTrials {
  public:
    /// Throws Error when the folder does not belong to a session with the trials of a task.
    explicit RunningTrials(const std::string& folder);

    /// Reads the recording since the last call. Throws Error when this fails.
    void look();
    /// A row for each attempt so far; the row of an unfinished attempt is not final.
    Table table() const;
    /// Number of attempts that have ended.
    size_t ended() const;

  private:
    recording::SessionFolder folder_;
    recording::SessionInfo info_;
    std::optional<recording::RawLogReader> log_;
    std::optional<SessionReader> reader_;
    std::optional<recording::ChunkPlace> last_;  // last chunk read
};

}  // namespace dihaptic::analysis
