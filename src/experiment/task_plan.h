// A task with its names looked up, for a scene: what the tick and the simulated hand read, and
// nobody changes.
#pragma once

#include "experiment/trials.h"

namespace dihaptic::experiment {

/// Index of the stretch before a trial's first state, among the phases that frames count.
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
        int finger = -1;   ///< that is judged; -1: any, all, or the middle of all (Exit)
        int state = -1;    ///< that it leads to
        int outcome = -1;  ///< that it ends the trial with
        int feedback = -1;
    };
    struct Step {
        HandStep step;
        int reach = -1;  ///< region
    };
    struct Stage {
        uint32_t shown = 0;  ///< regions, a bit each
        bool perturbed = true;
        int message = -1;
        int marker = 0;
        std::vector<Way> ways;
        std::vector<Step> hand;
    };
    std::vector<Stage> stages;  ///< by state

    /// A body that is put back between trials, and the box that must be clear of fingers for it.
    struct Home {
        int body;
        Pose X_WB;
        scene::Bounds box;
    };
    /// What one condition in one round has of regions, perturbations and places.
    struct Cell {
        std::vector<Vec3> p_W;
        std::vector<double> radius;
        std::vector<Perturbation> perturbations;
        std::vector<Home> homes;
    };
    std::vector<Cell> cells;            ///< by round, then condition
    std::vector<double> finger_radius;  ///< of the sphere around each finger's shape [m]
    int move_away = -1;                 ///< message while one is in the way

    const Cell& cell(const Trial& trial) const {
        const size_t conditions = std::max<size_t>(1, task.conditions.size());
        return cells[static_cast<size_t>(trial.round) * conditions +
                     static_cast<size_t>(trial.condition)];
    }
    /// "between trials", then the states.
    std::vector<std::string> phases() const;
};

/// Everything that is wrong with the task goes to `diagnostics`. Without errors, trials may be
/// made.
TaskPlan plan_task(const Task& task, const scene::Scene& scene, Diagnostics& diagnostics);

/// trial-list.csv with what trials are measured by: columns named reach_... (ReachMeasure).
Table frozen_list(const TaskPlan& plan, const scene::Scene& scene);

/// procedures.csv: what those who fit the answers need to know of each.
Table procedure_table(const TaskPlan& plan);

}  // namespace dihaptic::experiment
