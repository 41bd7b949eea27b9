// Computes the measures of a movement (task/plan/measures.h) from the trace of one attempt at a
// trial. docs/measures-of-behaviour.md gives the rules and equations.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "analysis/lifts.h"
#include "task/plan/measures.h"

namespace dihaptic::analysis {

/// The data kept from a tick.
struct MotionSample {
    double time;  ///< [s]
    int phase;
    Vec3 p_W;
    Vec3 v_W;
    Vec3 f_W;        ///< force of the hand on the channel that pushes it [N]
    double grip;     ///< [N]
    bool continues;  ///< neither a gap nor a pause precedes it
};

/// An attempt at a trial.
struct Attempt {
    std::vector<MotionSample> samples;  ///< from its first tick to its last
    task::MovementPlan plan;
    const rows::LiftRow* lift = nullptr;  ///< null: no object, or one finger
    double share = 0;                     ///< share of the perturbation that acted
};

/// Phases of the states in which measures are computed; -1: none.
struct MeasurePhases {
    std::vector<int> during;
    int go = -1;
    int step = -1;
};

/// Values of a measure's columns, in SI units unless a column's name states another; NaN if
/// missing.
struct MeasuredValues {
    std::vector<double> values;
    std::string why;  ///< reason why one is missing; empty if none is missing
};

/// Computes the measures of one attempt.
class AttemptMeasures {
  public:
    AttemptMeasures(const Attempt& attempt, const task::Movement& options,
                    const MeasurePhases& phases, double tick);

    MeasuredValues measure(const task::MeasureRow& row) const;

  private:
    using Values = std::vector<double>;
    /// Reason why no complete movement was found; empty if one was found.
    std::string find_movement(const MeasurePhases& phases);
    std::string find_run(const MeasurePhases& phases);
    void find_ends(size_t from, size_t peak);
    std::string why_too_small() const;
    std::string why_no_index() const;
    bool in_channel() const { return attempt_.plan.channel != 0 && attempt_.share != 0; }
    /// Whether the channel acts in a tick of the run.
    bool in_channel(size_t i) const {
        return in_channel() && (attempt_.plan.channel_states >> (run_[i].phase - 1) & 1u) != 0;
    }
    /// The values in the ticks from onset to end in which the channel acts.
    Values while_in_channel(const Values& of_run) const;
    /// Largest distance that the movement reached from its position at onset; `along`: along the
    /// line.
    double extent(bool along) const;
    void find_lines();
    std::string why_missing(const task::MeasureRow& row) const;
    std::string why_in_part(const task::MeasureRow& row) const;

    Values lateral_deviation() const;
    Values early_lateral_deviation() const;
    Values end_point_error() const;
    Values initial_direction() const;
    Values channel_force() const;
    Values adaptation_index() const;
    Values grip_latency() const;
    double path_length() const;
    double time(size_t i) const { return run_[i].time; }
    const rows::LiftRow& lift() const { return *attempt_.lift; }
    /// From onset to end.
    std::span<const double> whole(const Values& of_run) const {
        return std::span(of_run).subspan(onset_, end_ - onset_ + 1);
    }

    const Attempt& attempt_;
    const task::Movement& options_;
    double tick_;
    double go_;                          // time of the go signal [s]
    double step_;                        // time of the load step [s]
    std::span<const MotionSample> run_;  // the samples in the movement's states
    std::string no_onset_;  // reason why the movement has no onset; empty if it has one
    std::string no_end_;
    bool continued_ = false;  // the movement had begun before its states
    size_t onset_ = 0, peak_ = 0, end_ = 0;
    Vec3 along_W_, left_W_;
    /// By tick of the run. In a channel, the movement is found by the speed along the line, because
    /// walls that catch the hand beside their line throw it onto the line.
    std::vector<double> speed_, left_, force_, ideal_;
};

/// The first stroke of a movement: its fastest tick, and the tick before the next stroke begins.
/// A stroke ends where the speed has fallen by a fifth and rises again by a tenth of the largest
/// speed; a rise to less than a quarter of that speed is not yet a stroke.
struct Stroke {
    size_t peak = 0;
    size_t end = 0;
};
Stroke first_stroke(std::span<const double> speed);

/// Where x first turns back, after a change from its first value and before a return that are both
/// at least a tenth of its range and at least 2 mm; otherwise where it is largest in magnitude [m].
size_t first_turn(std::span<const double> x);

/// Spectral arc length of a speed profile (Balasubramanian et al. 2015): over frequencies up to 10
/// Hz whose amplitude is at least 5 % of the largest, after zero padding by a factor of 16.
double spectral_arc_length(std::span<const double> speed, double tick);

}  // namespace dihaptic::analysis
