// A task whose names have been looked up in a scene: constant data for the tick and the simulated
// hand.
#pragma once

#include "base/unmeasured.h"
#include "frame/task_frame.h"
#include "task/plan/formulas.h"
#include "task/plan/on_joint.h"
#include "task/plan/trials.h"

namespace dihaptic::task {

/// Phase number, in frames, of the time before a trial's first state.
constexpr int kBetween = 0;

/// A number about the trials for use in texts. `countdown`: seconds left in the state or the break,
/// rounded up.
enum class Figure {
    trial_num,
    trials,
    trials_left,  ///< including the running one
    trial_num_in_block,
    block_num,
    blocks,
    attempt,
    countdown,
    answer,  ///< as typed so far, or pointed at
};
constexpr auto enum_names(Figure) {
    return std::array{"trial_num", "trials", "trials_left", "trial_num_in_block",
                      "block_num", "blocks", "attempt",     "countdown",
                      "answer"};
}

/// A number in a text: a quantity of the task, or else a Figure.
struct TextNumber {
    Figure figure;
    Expression quantity;
};

struct TaskPlan {
    static constexpr size_t kMostStates = 64;  ///< a set of states has one bit each
    static constexpr int kMostSounds = frame::TaskFrame::kMostSounds;  ///< likewise for sounds

    Task task;
    std::vector<Trial> trials;
    std::vector<std::string> messages;
    std::vector<std::vector<TextNumber>> numbers;  ///< by message: numbers in its text, in order
    struct Outcome {
        std::string name;
        bool redo = false;
        bool ends_session = false;
        std::string hed{};
    };
    std::vector<Outcome> outcomes;
    int skipped = -1;  ///< the outcome of a trial that the operator skips

    struct Transition {
        Exit exit;
        Expression condition;  ///< empty for key, button, trigger and time
        int finger = 0;        ///< finger with the button
        int outcome = -1;      ///< outcome of the trial; see outcome_of()
        int feedback = -1;
        uint32_t sounds = 0;  ///< sounds that the exit starts, one bit each

        /// Whether the condition does not depend on the hand's motion.
        bool comes() const {
            return condition.empty() ? exit.has(WhenRow::comes) : !condition.follows_tick();
        }
    };
    struct Step {
        HandStep step;
        scene::FingerSet fingers = scene::FingerSet{}.set();  ///< fingers that move
        bool moves(size_t finger) const noexcept { return scene::contains(fingers, finger); }
    };
    /// Quantities for conditions and formulas; a director has a copy.
    Quantities quantities;

    /// A body that is placed, and the box that must be clear of fingers.
    struct StartPose {
        int body;
        Pose X_WB;
        scene::Bounds box;
        FormulaVec3 position;
        /// Used in place of `position`; such start poses come after the start pose of the joint's
        /// first body.
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
    /// A body that a state places, and where.
    struct Placement {
        StartPose pose;  // not used if the body keeps its position
        bool moves;      // whether the body's position changes
        bool stays;      // whether the body is kept there while the state lasts
    };
    /// Looks of bodies, proxies and targets; the radius of a target is a factor.
    struct Looks {
        std::vector<frame::LookFrame> things;
        std::vector<frame::TargetFrame> targets;
        uint32_t hidden_targets = 0;  ///< regions, one bit each
    };
    /// The questions of a state.
    struct Questions {
        struct Item {
            Question question;
            std::vector<int> lines;  ///< messages while the question is asked
        };
        std::vector<Item> items;
        bool is_form = false;      ///< the answers take effect once they are confirmed
        std::vector<int> confirm;  ///< messages while the confirmation is awaited
    };
    struct PlannedState {
        uint32_t shown = 0;  ///< regions shown, one bit each
        Looks looks;
        bool holds_cursor = false;
        int held_from =
            -1;  ///< the cursor is held where it was at the end of this state; -1: the last state
        std::vector<int> lines;  ///< messages
        int message = -1;
        int marker = 0;
        uint32_t sounds = 0;  ///< one bit each
        int interval = 0;
        Questions questions;
        std::vector<Placement> placements;
        std::vector<Drive> drives;
        std::vector<Motor> motors;
        std::vector<Transition> transitions;
        std::vector<Step> hand;
    };
    std::vector<PlannedState> states;  ///< by state

    /// A cell of the design: regions, perturbations and start poses of bodies for one condition in
    /// one round. Formulas get their values for each trial (task/run/trial_numbers.h).
    struct Cell {
        std::vector<Region> regions;
        std::vector<Vec3> p_W;  ///< centres of the regions
        std::vector<Perturbation> perturbations;
        std::vector<uint64_t> during;  ///< by perturbation: states in which it acts, one bit each
        std::vector<StartPose> start_poses;
        std::vector<Looks> looks;   ///< by state
        std::vector<int> formulas;  ///< of regions, start poses and perturbations

        bool acts(int perturbation, int state) const {
            return state >= 0 && (during[static_cast<size_t>(perturbation)] >> state & 1u) != 0;
        }
    };
    std::vector<Cell> cells;            ///< by round, then by condition; cells outside rounds last
    size_t bodies = 0;                  ///< number in the scene
    std::vector<double> finger_radius;  ///< radius of the sphere around each finger's shape [m]
    double longest_delay = 0;           ///< of any load [s]
    int move_away = -1;                 ///< message while a finger obstructs a body

    struct Page {
        PageSpec spec;
        int message = -1;  ///< text of the page

        /// One key that turns the page.
        char any_key() const { return spec.key.empty() ? '1' : spec.key.front(); }
    };
    std::vector<Page> pages;
    struct Opening {
        double rest = 0;  ///< [s]
        int first = 0;    ///< index of the opening's first page
        int pages = 0;
    };
    std::vector<Opening> openings;  ///< by block of the task
    int rest = -1;                  ///< message during a break
    int countdown = -1;             ///< line with the countdown
    std::vector<int> lines;         ///< messages that are shown throughout
    int object = -1;                ///< body index of the scene's object
    uint32_t going_on = 0;          ///< sounds that last while states name them, one bit each
    uint32_t throughout = 0;        ///< sounds that last throughout the session

    /// Quantities available to formulas, and the slots for their values.
    struct Symbols {
        struct Draw {
            int slot;
            double si;                  ///< unit of the draw's name
            std::vector<double> codes;  ///< codes of the draw's values, if they are texts
            double value(double drawn) const noexcept {
                return codes.empty() ? si * drawn : codes[static_cast<size_t>(drawn)];
            }
        };
        struct Levels {
            int slot;
            std::vector<double> levels;  ///< by condition, or by round
            bool of_round = false;
        };
        std::vector<Draw> draws;
        std::vector<Levels> factors;
        struct Changing {
            int slot = 0;
            int between = 0;  ///< slot in TaskPlan::between
        };
        std::vector<Changing> variables;
        int outcome = 0;
        std::vector<double> outcomes;  ///< code of each outcome's name
    };
    /// A custom measure of the task.
    struct Measured {
        CompiledFormula value;  ///< with the slots of `measured`
        Expression when;        ///< condition that selects ticks; empty: all
        Take take = Take::max;
        double window = 0;    ///< length of moving means [s]; 0: none
        uint64_t states = 0;  ///< one bit each

        /// Its value in a tick, as written in the file; NaN if `when` excludes the tick.
        double in_tick(std::span<const double> quantities) const noexcept {
            if (!when.empty() && when(quantities) == 0) return kUnmeasured;
            return value.value(quantities);
        }
    };
    Quantities measured;  ///< `quantities`, and further quantities for measures
    /// A custom measure that rules use, e.g. measure.hold for hold_N.
    struct RuleMeasure {
        Measured measured;  ///< with the slots of `quantities`
        int slot = -1;      ///< slot of its value when a trial has ended
    };
    std::vector<RuleMeasure> rule_measures;
    std::vector<LookBack> look_backs;  ///< those of rules, each after those that it depends on
    std::vector<Measured> custom_measures;
    /// Update of a variable after a trial.
    struct Change {
        std::optional<Expression> when;
        size_t variable = 0;
        CompiledFormula to;
        size_t look_backs = 0;  ///< end of the rule's look-backs in the plan's list; they begin
                                ///< where those of the previous rule end
    };
    Quantities between;  ///< quantities for the end of a block: only variables
    Symbols symbols;
    std::vector<CompiledFormula> formulas;
    std::vector<int> in_states;  ///< formulas
    /// The first finger of each participant's hand, which includes all fingers up to the next
    /// hand's.
    std::vector<size_t> first_fingers{0};
    /// A number that procedures choose. In frames, levels come after the variables.
    struct Level {
        size_t variable = 0;
        double standard = 0;         ///< [SI]
        double si = 1;               ///< unit of the number's name
        std::vector<double> values;  ///< levels at which trials are checked before the session [SI]
    };
    std::vector<Level> levels;
    std::vector<int> level_of_procedure;  ///< index of the level; -1: the procedure chooses a share
    int comparison = -1;                  ///< draw of the comparison interval
    int chose_comparison = -1;            ///< outcome
    int chose_standard = -1;              ///< outcome
    /// Values of variables, levels and answers, in this order, at the session's start.
    std::vector<frame::VariableFrame> start;
    std::vector<Change> changes;
    std::vector<std::optional<Expression>> until;  ///< by block

    size_t cell_index(const Trial& trial) const noexcept {
        const size_t conditions = std::max<size_t>(1, task.conditions.size());
        return static_cast<size_t>(trial.round) * conditions + static_cast<size_t>(trial.condition);
    }
    const Cell& cell(const Trial& trial) const { return cells[cell_index(trial)]; }
    /// Whether levels, and shares that procedures choose, have their standard value in the state;
    /// -1: no state.
    bool shows_standard(const Trial& trial, int state) const noexcept {
        return comparison >= 0 && state >= 0 &&
               states[static_cast<size_t>(state)].interval != interval_of(trial);
    }
    /// Interval of the comparison.
    int interval_of(const Trial& trial) const noexcept {
        return static_cast<int>(trial.draws[static_cast<size_t>(comparison)]);
    }
    /// Outcome of a trial that ends with this exit.
    int outcome_of(const Transition& transition, const Trial& trial) const noexcept {
        if (transition.exit.chooses == 0) return transition.outcome;
        return transition.exit.chooses == interval_of(trial) ? chose_comparison : chose_standard;
    }
    /// The number that the trial's procedure chooses; null if it chooses none.
    const Level* level_of(const Trial& trial) const noexcept {
        if (trial.procedure < 0) return nullptr;
        const int i = level_of_procedure[static_cast<size_t>(trial.procedure)];
        return i < 0 ? nullptr : &levels[static_cast<size_t>(i)];
    }
    /// The formulas that the trial uses.
    std::vector<int> used_in(const Trial& trial) const;
    /// The largest value of a number that may be a formula, over all trials and levels; if
    /// variables change it, its upper bound [SI].
    double largest(const Formula& number) const;
    /// Names of the phases: "between trials", then the states.
    std::vector<std::string> phases() const;
};

/// Problems with the task go to `diagnostics`. Without errors, trials can be generated.
TaskPlan plan_task(const Task& task, const scene::Scene& scene, Diagnostics& diagnostics);

/// trial-list.csv, with the data for measuring each trial (task/plan/reach_plan.h).
Table frozen_list(const TaskPlan& plan, const scene::Scene& scene);

/// procedures.csv: the data of each procedure for fitting its answers.
Table procedure_table(const TaskPlan& plan);

}  // namespace dihaptic::task
