// Computes the measures of a movement (task/plan/measures.h) from the trace of one trial attempt.
// docs/measures-of-behaviour.md gives the rules and equations.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "analysis/lifts.h"
#include "task/plan/measures.h"

namespace dihaptic::analysis {

/// The data stored for one tick.
struct MotionSample {
    double time;  ///< [s]
    int phase;
    Vec3 p_W;
    Vec3 v_W;
    Vec3 f_W;        ///< force with which the hand pushes against the channel [N]
    double grip;     ///< [N]
    bool continues;  ///< whether the sample comes directly after the previous one, without a gap or
                     ///< pause
};

/// The trace of one trial attempt, and what is known about it.
struct Attempt {
    std::vector<MotionSample> samples;  ///< samples from the first tick of the attempt to the last
    task::MovementPlan plan;
    const rows::LiftRow* lift = nullptr;  ///< null if there is no object, or only one finger
    double share = 0;                     ///< fraction of the perturbation that acted
};

/// Indices of the states (phases) in which measures are computed; -1 if there is no such state.
struct MeasurePhases {
    std::vector<int> during;
    int go = -1;
    int step = -1;
};

/// Values of a measure's columns; NaN if missing. In SI units, unless the name of a column states
/// another unit.
struct MeasuredValues {
    std::vector<double> values;
    std::string why;  ///< reason why a value is missing; empty if no value is missing
};

/// Computes the measures of one attempt.
class AttemptMeasures {
  public:
    AttemptMeasures(const Attempt& attempt, const task::Movement& options,
                    const MeasurePhases& phases, double tick);

    MeasuredValues measure(const task::MeasureRow& row) const;

  private:
    using Values = std::vector<double>;
    /// Finds the movement. Returns the reason why no complete movement was found; empty if one was
    /// found.
    std::string find_movement(const MeasurePhases& phases);
    std::string find_run(const MeasurePhases& phases);
    void find_ends(size_t from, size_t peak);
    std::string why_too_small() const;
    std::string why_no_index() const;
    bool in_channel() const { return attempt_.plan.channel != 0 && attempt_.share != 0; }
    /// Whether the channel acts in the i-th tick of the run.
    bool in_channel(size_t i) const {
        return in_channel() && (attempt_.plan.channel_states >> (run_[i].phase - 1) & 1u) != 0;
    }
    /// The values in those ticks between onset and end in which the channel acts.
    Values while_in_channel(const Values& of_run) const;
    /// Largest distance of the movement from its position at onset. `along`: measured along the
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
    /// The values from onset to end.
    std::span<const double> whole(const Values& of_run) const {
        return std::span(of_run).subspan(onset_, end_ - onset_ + 1);
    }

    const Attempt& attempt_;
    const task::Movement& options_;
    double tick_;
    double go_;                          // time of the go signal [s]
    double step_;                        // time of the load step [s]
    std::span<const MotionSample> run_;  // the samples in the states of the movement
    std::string no_onset_;  // reason why no onset of the movement was found; empty if one was found
    std::string no_end_;
    bool continued_ = false;  // whether the movement had begun before its states
    size_t onset_ = 0, peak_ = 0, end_ = 0;
    Vec3 along_W_, left_W_;
    /// Values for each tick of the run. In a channel, the movement is detected from the speed along
    /// the line, because walls that catch the hand beside the line throw it onto the line.
    std::vector<double> speed_, left_, force_, ideal_;
};

/// The first stroke of a movement: its fastest tick, and the tick before the next stroke begins. A
/// stroke ends when the speed has fallen by a fifth of the stroke's own peak and then rises again
/// by a tenth of the largest speed. A rise to less than a quarter of the largest speed does not
/// count as a new stroke.
struct Stroke {
    size_t peak = 0;
    size_t end = 0;
};
Stroke first_stroke(std::span<const double> speed);

/// Index at which x first reverses: both the change from its first value and the return must be at
/// least a tenth of the range of x and at least 2 mm. If x does not reverse, the index at which x
/// is largest in magnitude [m].
size_t first_turn(std::span<const double> x);

/// Spectral arc length of a speed profile (Balasubramanian et al. 2015). Uses frequencies up to 10
/// Hz at which the amplitude is at least 5 % of the largest amplitude, after zero padding by a
/// factor of 16.
double spectral_arc_length(std::span<const double> speed, double tick);

}  // namespace dihaptic::analysis
