// A task whose names have been looked up in a scene. The plan is constant data, used in each tick
// and by the simulated hand.
#pragma once

#include "base/unmeasured.h"
#include "frame/task_frame.h"
#include "task/plan/formulas.h"
#include "task/plan/on_joint.h"
#include "task/plan/trials.h"

namespace dihaptic::task {

/// Phase number in frames for the time before a trial's first state.
constexpr int kBetween = 0;

/// A number about the trials, for use in texts. `countdown` is the number of seconds left in the
/// state or the break, rounded up.
enum class Figure {
    trial_num,
    trials,
    trials_left,  ///< includes the running trial
    trial_num_in_block,
    block_num,
    blocks,
    attempt,
    countdown,
    answer,  ///< answer as typed or pointed at so far
};
constexpr auto enum_names(Figure) {
    return std::array{"trial_num", "trials", "trials_left", "trial_num_in_block",
                      "block_num", "blocks", "attempt",     "countdown",
                      "answer"};
}

/// A number in a text: either a quantity of the task or a Figure.
struct TextNumber {
    Figure figure;
    Expression quantity;
};

struct TaskPlan {
    /// Limit due to sets of states, which have one bit for each state.
    static constexpr size_t kMostStates = 64;
    /// Limit due to sets of sounds.
    static constexpr int kMostSounds = frame::TaskFrame::kMostSounds;

    Task task;
    std::vector<Trial> trials;
    std::vector<std::string> messages;
    /// For each message, the numbers in its text, in order.
    std::vector<std::vector<TextNumber>> numbers;
    struct Outcome {
        std::string name;
        bool redo = false;
        bool ends_session = false;
        std::string hed{};
    };
    std::vector<Outcome> outcomes;
    int skipped = -1;  ///< index of the outcome of trials that the operator skips

    struct Transition {
        Exit exit;
        Expression condition;  ///< empty if `exit` is by key, button, trigger or time
        int finger = 0;        ///< index of the finger whose device has the button
        int outcome = -1;      ///< index of the trial's outcome; see outcome_of()
        int feedback = -1;
        uint32_t sounds = 0;  ///< sounds that the exit starts, one bit for each sound

        /// Whether the condition does not depend on the hand's motion.
        bool comes() const {
            return condition.empty() ? exit.has(WhenRow::comes) : !condition.follows_tick();
        }
    };
    struct Step {
        HandStep step;
        scene::FingerSet fingers = scene::FingerSet{}.set();  ///< fingers that move in this step
        bool moves(size_t finger) const noexcept { return scene::contains(fingers, finger); }
    };
    /// Quantities for conditions and formulas; a director uses a copy of them.
    Quantities quantities;

    /// A body that is placed, and the box around it that must be clear of fingers.
    struct StartPose {
        int body;
        Pose X_WB;
        scene::Bounds box;
        FormulaVec3 position;
        /// Set if the body is placed by a joint instead of by `position`; the start pose of the
        /// joint's first body then precedes this one.
        std::optional<OnJoint> joint = std::nullopt;
        Formula coordinate{};
        /// The body's initial velocity, or the rate of its joint.
        FormulaVec3 velocity{};
        Formula rate{};
        BodyMotion motion{};

        template <class Visitor>
        void visit(Visitor& v) {
            if (joint) {
                v("coordinate", coordinate);
                v("rate", rate);
            } else {
                v("position", position);
                v("velocity", velocity);
            }
        }
    };
    /// The placement of a body by a state.
    struct Placement {
        StartPose pose;  // not used if the body stays at its current position
        bool moves;      // whether the placement changes the body's position
        bool stays;      // whether the body is kept in place while the state lasts
    };
    /// Looks of bodies, proxies and targets. The radius of a target is a factor on its actual
    /// radius.
    struct Looks {
        std::vector<frame::LookFrame> things;
        std::vector<frame::TargetFrame> targets;
        uint32_t hidden_targets = 0;  ///< hidden regions, one bit for each region
    };
    /// The questions that a state asks.
    struct Questions {
        struct Item {
            Question question;
            std::vector<int> lines;  ///< messages shown while the question is asked
        };
        std::vector<Item> items;
        bool is_form = false;      ///< whether the answers take effect only once they are confirmed
        std::vector<int> confirm;  ///< messages shown while confirmation is awaited
    };
    struct PlannedState {
        uint32_t shown = 0;  ///< regions that are shown, one bit for each region
        Looks looks;
        bool holds_cursor = false;
        int held_from = -1;  ///< state at whose end the cursor's held position was displayed; -1
                             ///< for the previous state
        std::vector<int> lines;  ///< indices of the messages that are lines
        int message = -1;
        int marker = 0;
        uint32_t sounds = 0;  ///< sounds of the state, one bit for each sound
        int interval = 0;
        Questions questions;
        std::vector<Placement> placements;
        std::vector<Drive> drives;
        std::vector<Motor> motors;
        std::vector<Transition> transitions;
        std::vector<Step> hand;
    };
    std::vector<PlannedState> states;  ///< one for each state of the task

    /// A cell of the design: regions, perturbations and start poses of bodies for one condition in
    /// one round. Formulas are evaluated for each trial (task/run/trial_numbers.h).
    struct Cell {
        std::vector<Region> regions;
        std::vector<Vec3> p_W;  ///< centres of the regions
        std::vector<Perturbation> perturbations;
        /// For each perturbation, the states in which it acts, one bit for each state.
        std::vector<uint64_t> during;
        std::vector<StartPose> start_poses;
        std::vector<Looks> looks;  ///< one for each state
        /// Indices of the formulas in regions, start poses and perturbations.
        std::vector<int> formulas;

        bool acts(int perturbation, int state) const {
            return state >= 0 && (during[static_cast<size_t>(perturbation)] >> state & 1u) != 0;
        }
    };
    /// Ordered by round, then by condition; cells outside the rounds come last.
    std::vector<Cell> cells;
    size_t bodies = 0;                  ///< number of bodies in the scene
    std::vector<double> finger_radius;  ///< radius of a sphere around each finger's shape [m]
    double longest_delay = 0;           ///< longest delay of any load [s]
    int move_away = -1;                 ///< message shown while a finger obstructs a body

    struct Page {
        PageSpec spec;
        int message = -1;  ///< index of the message with the page's text

        /// Returns one of the keys that turn the page.
        char any_key() const { return spec.key.empty() ? '1' : spec.key.front(); }
    };
    std::vector<Page> pages;
    struct Opening {
        double rest = 0;  ///< [s]
        int first = 0;    ///< index of the first page in this opening
        int pages = 0;
    };
    std::vector<Opening> openings;  ///< one for each block of the task
    int rest = -1;                  ///< message shown during a break
    int countdown = -1;             ///< message of the line with the countdown
    std::vector<int> lines;         ///< messages shown throughout the session
    int object = -1;                ///< body index of the scene's object
    /// Sounds that last as long as states name them, one bit for each sound.
    uint32_t going_on = 0;
    uint32_t throughout = 0;  ///< sounds that last throughout the session, one bit for each sound

    /// A custom measure of the task.
    struct Measured {
        CompiledFormula value;  ///< formula that uses the slots of `measured`
        Expression when;        ///< condition that selects ticks; if empty, all ticks are used
        Take take = Take::max;
        double window = 0;    ///< length of the moving mean [s]; 0 for none
        uint64_t states = 0;  ///< states in which the measure is taken, one bit for each state

        /// Returns the measure's value in a tick, as written in the file, or NaN if `when` excludes
        /// the tick.
        double in_tick(std::span<const double> values) const noexcept {
            if (!when.empty() && when(values) == 0) return kUnmeasured;
            return value.value(values);
        }
    };
    Quantities measured;  ///< `quantities`, followed by further quantities for measures
    /// A custom measure used in rules, e.g. measure.hold for hold_N.
    struct RuleMeasure {
        Measured measured;  ///< measure that uses the slots of `quantities`
        int slot = -1;      ///< slot of the measure's value at the end of a trial
    };
    std::vector<RuleMeasure> rule_measures;
    /// Look-backs of rules, ordered so that each follows those it depends on.
    std::vector<LookBack> look_backs;
    std::vector<Measured> custom_measures;
    /// An update of a variable after a trial.
    struct Change {
        std::optional<Expression> when;
        size_t variable = 0;
        CompiledFormula to;
        size_t look_backs = 0;  ///< end of the range of this rule's look-backs in the plan's list;
                                ///< the range begins where that of the previous rule ends
    };
    /// Quantities available at the end of a block, which are only the variables.
    Quantities between;
    Symbols symbols;
    std::vector<CompiledFormula> formulas;
    std::vector<int> in_states;  ///< indices of the formulas in states
    /// The index of the first finger in each participant's hand. A hand includes all fingers up to
    /// the first finger of the next hand.
    std::vector<size_t> first_fingers{0};
    /// A number that procedures choose. In frames, levels are stored after the variables.
    struct Level {
        size_t variable = 0;
        double standard = 0;  ///< [SI]
        double si = 1;        ///< unit of the number's name, as a multiple of the SI unit
        /// Levels for which trials are checked before the session [SI].
        std::vector<double> values;
    };
    std::vector<Level> levels;
    std::vector<int> level_of_procedure;  ///< index of the procedure's level; -1 if the procedure
                                          ///< chooses a share
    int comparison = -1;        ///< index of the draw that determines the comparison interval
    int chose_comparison = -1;  ///< index of the outcome
    int chose_standard = -1;    ///< index of the outcome
    /// Values of variables, levels and answers at the start of the session, in this order.
    std::vector<frame::VariableFrame> start;
    std::vector<Change> changes;
    std::vector<std::optional<Expression>> until;  ///< one for each block of the task

    size_t cell_index(const Trial& trial) const noexcept {
        const size_t conditions = std::max<size_t>(1, task.conditions.size());
        return static_cast<size_t>(trial.round) * conditions + static_cast<size_t>(trial.condition);
    }
    const Cell& cell(const Trial& trial) const { return cells[cell_index(trial)]; }
    /// Whether levels, and shares that procedures choose, have their standard values in the state.
    /// `state` is -1 if no state is active.
    bool shows_standard(const Trial& trial, int state) const noexcept {
        return comparison >= 0 && state >= 0 &&
               states[static_cast<size_t>(state)].interval != interval_of(trial);
    }
    /// Returns the interval that contains the comparison in this trial.
    int interval_of(const Trial& trial) const noexcept {
        return static_cast<int>(trial.draws[static_cast<size_t>(comparison)]);
    }
    /// Returns the outcome of a trial that ends with this transition.
    int outcome_of(const Transition& transition, const Trial& trial) const noexcept {
        if (transition.exit.chooses == 0) return transition.outcome;
        return transition.exit.chooses == interval_of(trial) ? chose_comparison : chose_standard;
    }
    /// Returns the number that the trial's procedure chooses, or null if it chooses none.
    const Level* level_of(const Trial& trial) const noexcept {
        if (trial.procedure < 0) return nullptr;
        const int i = level_of_procedure[static_cast<size_t>(trial.procedure)];
        return i < 0 ? nullptr : &levels[static_cast<size_t>(i)];
    }
    /// Returns the indices of the formulas that the trial uses.
    std::vector<int> used_in(const Trial& trial) const;
    /// Returns the largest value over all trials and levels of a number that may be a formula. If
    /// the number depends on variables, returns its upper bound [SI].
    double largest(const Formula& number) const;
    /// Returns the names of the phases: "between trials", followed by the names of the states.
    std::vector<std::string> phases() const;
};

/// Plans a task. Problems are added to `diagnostics`. If there are no errors, trials can be
/// generated.
TaskPlan plan_task(const Task& task, const scene::Scene& scene, Diagnostics& diagnostics);

/// Makes trial-list.csv, including the data needed to measure each trial (task/plan/reach_plan.h).
Table frozen_list(const TaskPlan& plan, const scene::Scene& scene);

/// Makes procedures.csv: the data needed to fit the answers of each procedure.
Table procedure_table(const TaskPlan& plan);

}  // namespace dihaptic::task
