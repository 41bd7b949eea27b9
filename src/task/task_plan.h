// A task with its names looked up in a scene: constant data that the tick and the simulated hand
// read.
#pragma once

#include "task/trials.h"

namespace dihaptic::task {

/// Phase number, in frames, of the time before a trial's first state.
constexpr int kBetween = 0;

struct TaskPlan {
    Task task;
    std::vector<Trial> trials;
    std::vector<std::string> messages;
    struct Outcome {
        std::string name;
        bool redo;
    };
    std::vector<Outcome> outcomes;
    int skipped = -1;  ///< the outcome of a trial that the operator skips

    struct Way {
        Exit exit;
        int region = -1;
        int body = -1;
        int finger = -1;   ///< finger that is judged; -1: any, all, or the middle of all (Exit)
        int state = -1;    ///< state that it leads to
        int outcome = -1;  ///< outcome that it ends the trial with
        int feedback = -1;
    };
    struct Step {
        HandStep step;
        int reach = -1;  ///< region
    };
    struct Stage {
        uint32_t shown = 0;  ///< regions shown, one bit each
        bool perturbed = true;
        int message = -1;
        int marker = 0;
        std::vector<Way> ways;
        std::vector<Step> hand;
    };
    std::vector<Stage> stages;  ///< by state

    /// A body that is put back between trials, and the box that must then be clear of fingers.
    struct Home {
        int body;
        Pose X_WB;
        scene::Bounds box;
    };
    /// Regions, perturbations and bodies' places of one condition in one round.
    struct Cell {
        std::vector<Vec3> p_W;
        std::vector<double> radius;
        std::vector<Perturbation> perturbations;
        std::vector<Home> homes;
    };
    std::vector<Cell> cells;            ///< by round, then condition
    std::vector<double> finger_radius;  ///< radius of the sphere around each finger's shape [m]
    int move_away = -1;                 ///< message while a finger is in the way

    const Cell& cell(const Trial& trial) const {
        const size_t conditions = std::max<size_t>(1, task.conditions.size());
        return cells[static_cast<size_t>(trial.round) * conditions +
                     static_cast<size_t>(trial.condition)];
    }
    /// Names of the phases: "between trials", then the states.
    std::vector<std::string> phases() const;
};

/// Problems with the task go to `diagnostics`. If there is no error, trials may be made.
TaskPlan plan_task(const Task& task, const scene::Scene& scene, Diagnostics& diagnostics);

/// trial-list.csv, with what is needed to measure each trial (task/reach_plan.h).
Table frozen_list(const TaskPlan& plan, const scene::Scene& scene);

/// procedures.csv: what is needed of each procedure to fit its answers.
Table procedure_table(const TaskPlan& plan);

}  // namespace dihaptic::task
