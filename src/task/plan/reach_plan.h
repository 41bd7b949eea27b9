// How each trial's reach is measured (ReachMeasure). This is frozen in the trial's row of
// trial-list.csv, in columns named reach_...
#pragma once

#include <string>
#include <vector>

#include "rows/row_file.h"
#include "task/plan/task_plan.h"

namespace dihaptic::task {

struct ReachPlan {
    std::string finger;          ///< name
    double distance = 0;         ///< distance from from_W at which the angle is measured [m]
    Vec3 from_W = Vec3::Zero();  ///< [m]
    Vec3 to_W = Vec3::Zero();
    Vec3 axis_W = Vec3::UnitZ();  ///< axis about which angles are measured, a unit vector
    std::string phases;           ///< phases in which the reach is measured, e.g. "2 3"
    Measure measure = Measure::angle;

    /// Returns the numbers listed in `phases`.
    std::vector<int> phase_numbers() const;

    template <class Self, class Visitor>
    static void visit(Self& f, Visitor& v) {
        v("reach_finger", f.finger, "", "finger whose reach is measured");
        v("reach_at", f.distance, "mm",
          "distance from the reach's start at which the angle is measured");
        rows::visit_vector(v, "reach_from", f.from_W, "mm", "its start");
        rows::visit_vector(v, "reach_to", f.to_W, "mm", "its target");
        rows::visit_vector(v, "reach_axis", f.axis_W, "1", "axis of the angles");
        v("reach_phase", f.phases, "", "phases in which the reach is measured");
        v("reach_measure", f.measure, "", "measured quantity: angle or extent");
    }
};

/// Appends the columns for reaches to a list with one row for each trial of the plan. The task must
/// measure a reach.
void add_reaches(Table& list, const TaskPlan& plan, const scene::Scene& scene);

/// Name of the first column for reaches; the list's own columns precede it.
inline constexpr const char* kFirstReachColumn = "reach_finger";

/// Axis of the first of the cell's perturbations that has an axis. It is used in trials with and
/// without the block's perturbation, so that both are measured in the same way.
Vec3 usual_axis(const TaskPlan::Cell& cell);

/// Reads the reach of each trial from trial-list.csv. Returns an empty list if the task measures no
/// reach. In a truncated line, missing fields are read as an empty finger and NaN.
std::vector<ReachPlan> read_reaches(const std::string& file);

}  // namespace dihaptic::task
