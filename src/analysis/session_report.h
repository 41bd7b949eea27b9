// Creates, from raw.log, the files that a lab reads: trials.csv, phases.csv, episodes.csv,
// lifts.csv, events.csv and session.nwb. A session that was killed is treated like a session that
// ended normally.
#pragma once

#include <bit>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "analysis/episodes.h"
#include "base/table.h"
#include "frame/frame.h"
#include "recording/convergence.h"
#include "recording/log_health.h"
#include "recording/raw_log.h"
#include "recording/session.h"
#include "rows/phase_row.h"

namespace dihaptic::analysis {

struct SessionFigures {
    std::vector<rows::PhaseRow> phases;
    std::optional<Table> trials;    ///< the task's trials, including those in earlier parts
    std::vector<Episode> episodes;  ///< the episodes of the object
    int64_t frames = 0;
    recording::LogHealth log;           ///< gaps in the log
    double tick = 0;                    ///< period of the clock [s]
    double duration = 0;                ///< [s]
    uint32_t status = 0;                ///< all status bits that occurred, combined
    std::vector<int64_t> status_ticks;  ///< number of ticks in which each status bit was set
    /// The unexplained part of the ticks' balances (dynamics/balance.h): the sum of the energy over
    /// all ticks [J], and the largest changes of linear and angular momentum in any tick [N*s],
    /// [N*m*s].
    double energy_imbalance = 0;
    double momentum_imbalance = 0;
    double angular_imbalance = 0;
    std::vector<std::string> implausible;  ///< analysis/plausibility.h
    recording::Convergence convergence;

    /// Whether any value was not a number, in which case none of the figures can be trusted.
    bool diverged() const { return (status & kNotFinite) != 0; }
    /// Whether the session diverged, or force was off after another fault, so that the forces felt
    /// differ from those planned. A stop by the operator is an interruption, not a failure.
    bool failed() const {
        return diverged() || ((status & kForceOff) != 0 && (status & kStopped) == 0);
    }
    int64_t ticks_with(Status bit) const { return status_ticks[place_of(bit)]; }
    int64_t& ticks_with(Status bit) { return status_ticks[place_of(bit)]; }
    /// Returns the phase with this name; null if there is none.
    const rows::PhaseRow* phase(const std::string& name) const;
    /// Describes the figures because of which the session has the status kUnbalanced.
    std::string describe_imbalance() const;

  private:
    static size_t place_of(Status bit) {
        return static_cast<size_t>(std::countr_zero(static_cast<uint32_t>(bit)));
    }
};

/// Writes session.nwb, trials.csv, phases.csv, episodes.csv, lifts.csv, events.csv and, after a
/// fault, fault.csv. Writes session.yaml last, with `info` and the session's state, which becomes
/// `recovered` when the log is damaged. Throws Error when writing fails, or when existing files
/// contain more data than the log now yields.
SessionFigures finish_session(const recording::SessionFolder& folder, recording::SessionInfo info,
                              const std::function<void(double)>& progress);

/// Processes the frames of a session in order, either from its log or while the session runs, and
/// computes the contents of the session's files.
class SessionReader {
  public:
    /// `folder` must contain the frozen inputs, and `info` must contain the phases, object and
    /// participant.
    SessionReader(const recording::SessionFolder& folder, const recording::SessionInfo& info,
                  const recording::LogHead& head);
    SessionReader(SessionReader&&) noexcept;
    ~SessionReader();
    void add(const frame::Frame& frame);
    /// Returns the trial attempts so far, in the form in which trials.csv will list them; without a
    /// task, the table has no rows.
    Table trials() const;
    /// Number of attempts that have ended.
    size_t ended_trials() const;

  private:
    friend SessionFigures finish_session(const recording::SessionFolder&, recording::SessionInfo,
                                         const std::function<void(double)>&);
    friend SessionFigures finish_tables(const recording::SessionFolder&, recording::SessionInfo,
                                        SessionReader);
    struct Pass;
    std::unique_ptr<Pass> pass_;
};

/// Like finish_session(), but for a session that has no log and was processed while it ran: writes
/// all tables and session.yaml, but no session.nwb.
SessionFigures finish_tables(const recording::SessionFolder& folder, recording::SessionInfo info,
                             SessionReader reader);

/// Adds a note unless `info` already contains it, because a session may be recovered more than
/// once.
void add_note(recording::SessionInfo& info, const std::string& note);

/// Reads every setting of the session, with its origin, from settings.csv. Returns no rows if that
/// file is missing.
Table read_settings(const recording::SessionFolder& folder);

}  // namespace dihaptic::analysis
