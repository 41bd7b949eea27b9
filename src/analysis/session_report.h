// Makes, from raw.log, the files that a lab reads: trials.csv, phases.csv, episodes.csv, lifts.csv,
// events.csv and session.nwb. A session that was killed is treated like one that ended.
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
    std::optional<Table> trials;    ///< a task's trials, with those of the session's earlier parts
    std::vector<Episode> episodes;  ///< the object's episodes
    int64_t frames = 0;
    recording::LogHealth log;           ///< gaps in the log
    double tick = 0;                    ///< period of the clock [s]
    double duration = 0;                ///< [s]
    uint32_t status = 0;                ///< all status bits that occurred
    std::vector<int64_t> status_ticks;  ///< number of ticks with each status bit
    /// The part of the ticks' balances (dynamics/balance.h) that is unexplained: the energy of all
    /// ticks together [J], and the largest changes of momentum in a tick [N*s], [N*m*s].
    double energy_imbalance = 0;
    double momentum_imbalance = 0;
    double angular_imbalance = 0;
    std::vector<std::string> implausible;  ///< analysis/plausibility.h
    recording::Convergence convergence;

    /// Whether a value was not a number, so that no figure can be trusted.
    bool diverged() const { return (status & kNotFinite) != 0; }
    /// Whether the session diverged, or force was off after another fault, so that the felt forces
    /// differ from the planned ones. A stop by the operator is an interruption, not a failure.
    bool failed() const {
        return diverged() || ((status & kForceOff) != 0 && (status & kStopped) == 0);
    }
    int64_t ticks_with(Status bit) const { return status_ticks[place_of(bit)]; }
    int64_t& ticks_with(Status bit) { return status_ticks[place_of(bit)]; }
    /// The phase with this name; null if there is none.
    const rows::PhaseRow* phase(const std::string& name) const;
    /// The figures that led to kUnbalanced in the session.
    std::string describe_imbalance() const;

  private:
    static size_t place_of(Status bit) {
        return static_cast<size_t>(std::countr_zero(static_cast<uint32_t>(bit)));
    }
};

/// Writes session.nwb, trials.csv, phases.csv, episodes.csv, lifts.csv, events.csv and, after a
/// fault, fault.csv; and last session.yaml with `info` and its state, which becomes `recovered`
/// when the log is damaged. Throws Error when this fails, or when existing files contain more than
/// the log now yields.
SessionFigures finish_session(const recording::SessionFolder& folder, recording::SessionInfo info,
                              const std::function<void(double)>& progress);

/// Processes a session's frames in order, while it runs or from its log, and computes the contents
/// of its files.
class SessionReader {
  public:
    /// `folder` must contain the frozen inputs, and `info` the phases, object and participant.
    SessionReader(const recording::SessionFolder& folder, const recording::SessionInfo& info,
                  const recording::LogHead& head);
    SessionReader(SessionReader&&) noexcept;
    ~SessionReader();
    void add(const frame::Frame& frame);
    /// The attempts at a task's trials so far, as trials.csv will list them; without a task, no
    /// rows.
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

/// Like finish_session(), for a session that has no log and was read while it ran: writes all
/// tables and session.yaml, but no session.nwb.
SessionFigures finish_tables(const recording::SessionFolder& folder, recording::SessionInfo info,
                             SessionReader reader);

/// Adds a note unless `info` already contains it: a session may be recovered more than once.
void add_note(recording::SessionInfo& info, const std::string& note);

/// Every setting of the session with its origin, from settings.csv; no rows if that file is
/// missing.
Table read_settings(const recording::SessionFolder& folder);

}  // namespace dihaptic::analysis
