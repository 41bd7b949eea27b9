// From raw.log to what a lab reads: trials.csv, phases.csv, episodes.csv, lifts.csv,
// events.csv and session.nwb. A session that ended and one that was killed go the same way.
#pragma once

#include <bit>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "analysis/episodes.h"
#include "base/table.h"
#include "recording/log_health.h"
#include "recording/raw_log.h"
#include "recording/session.h"
#include "servo/frame.h"

namespace dihaptic::analysis {

struct PhaseFigures {
    int trial = 0;
    std::string name;
    double start = 0;  ///< [s]
    double end = 0;
    double mean_grip = 0, peak_grip = 0;      ///< [N]; NaN with one finger
    double mean_load = 0;                     ///< [N]
    double mean_force = 0, peak_force = 0;    ///< on the busiest finger; on any [N]
    double mean_torque = 0, peak_torque = 0;  ///< on any [N*m]; NaN without orientation
    double slip = 0;         ///< [m]; NaN unless every finger holds the object throughout
    double weight_felt = 0;  ///< share of the object's weight; NaN unless it is carried
};

struct SessionFigures {
    std::vector<PhaseFigures> phases;
    std::optional<Table> trials;       ///< of a task, those of earlier parts of the session too
    std::vector<Episode> episodes;     ///< of the object
    std::vector<std::string> fingers;  ///< names
    int64_t frames = 0;
    recording::LogHealth log;           ///< what is missing
    double tick = 0;                    ///< period of the clock [s]
    double duration = 0;                ///< [s]
    uint32_t status = 0;                ///< all status bits that occurred
    std::vector<int64_t> status_ticks;  ///< by bit

    /// Something was not a number: no figure can be trusted.
    bool diverged() const { return (status & servo::kNotFinite) != 0; }
    /// Diverged, or force was off after another fault: what was felt is not what was planned. That
    /// an operator stopped it is no failure, but an interruption.
    bool failed() const {
        return diverged() || ((status & servo::kForceOff) != 0 && (status & servo::kStopped) == 0);
    }
    int64_t ticks_with(servo::Status bit) const { return status_ticks[place_of(bit)]; }
    int64_t& ticks_with(servo::Status bit) { return status_ticks[place_of(bit)]; }
    /// The phase of that name, or null.
    const PhaseFigures* phase(const std::string& name) const;

  private:
    static size_t place_of(servo::Status bit) {
        return static_cast<size_t>(std::countr_zero(static_cast<uint32_t>(bit)));
    }
};

/// "thumb, index"
std::string finger_list(const Episode& episode, const std::vector<std::string>& names);

/// Writes session.nwb, trials.csv, phases.csv, episodes.csv, lifts.csv, events.csv and, after a
/// fault, fault.csv; at last session.yaml with `info`, whose state they have then; it is
/// `recovered` when the log is damaged. Throws Error when it cannot, or when those that are there
/// tell of more than the log does now.
SessionFigures finish_session(const recording::SessionFolder& folder, recording::SessionInfo info,
                              const std::function<void(double)>& progress);

/// Reads a session's frames, each in turn, as they arise or out of its log.
class SessionReader {
  public:
    /// `folder` has the frozen inputs; of `info` its phases, object and participant are known.
    SessionReader(const recording::SessionFolder& folder, const recording::SessionInfo& info,
                  const recording::LogHead& head);
    SessionReader(SessionReader&&) noexcept;
    ~SessionReader();
    void add(const servo::Frame& frame);

  private:
    friend SessionFigures finish_session(const recording::SessionFolder&, recording::SessionInfo,
                                         const std::function<void(double)>&);
    friend SessionFigures finish_tables(const recording::SessionFolder&,
                                        const recording::SessionInfo&, SessionReader);
    struct Pass;
    std::unique_ptr<Pass> pass_;
};

/// The same as finish_session() of a session that was read while it ran, and has no log: all tables
/// and session.yaml, no session.nwb.
SessionFigures finish_tables(const recording::SessionFolder& folder,
                             const recording::SessionInfo& info, SessionReader reader);

/// Adds a note, unless it is there: a session may be recovered more than once.
void add_note(recording::SessionInfo& info, const std::string& note);

/// Every setting of the session, with its origin: settings.csv, or no row when it is gone.
Table read_settings(const recording::SessionFolder& folder);

}  // namespace dihaptic::analysis
