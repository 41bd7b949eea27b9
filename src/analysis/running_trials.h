// Reads the part of a running session's log that has been written so far, to find the results of
// its trials: the figures that trials.csv will contain.
#pragma once

#include <optional>

#include "analysis/session_report.h"
#include "recording/raw_log.h"
#include "recording/session.h"

namespace dihaptic::analysis {

class RunningTrials {
  public:
    /// Throws Error when the folder does not contain a session with a task that has trials.
    explicit RunningTrials(const std::string& folder);

    /// Reads what has been recorded since the last call. Throws Error when this fails.
    void look();
    /// Returns a row for each attempt so far; the row of an attempt that has not ended may still
    /// change.
    Table table() const;
    /// Number of attempts that have ended.
    size_t ended() const;

  private:
    recording::SessionFolder folder_;
    recording::SessionInfo info_;
    std::optional<recording::RawLogReader> log_;
    std::optional<SessionReader> reader_;
    std::optional<recording::ChunkPlace> last_;  // the last chunk that was read
};

}  // namespace dihaptic::analysis
