// Plans the initial placement of bodies in trials, and the placements, drives and motors of states.
#pragma once

#include "task/plan/names.h"

namespace dihaptic::task {

class BodyPlanner : Planning {
  public:
    explicit BodyPlanner(const Planning& given) : Planning(given) {}

    /// Reports an error if the scene does not allow the body to move.
    void check_movable(const Ref<scene::Body>& body, const Place& place, const char* key);
    /// Checks the bodies that a condition places.
    void check(const Condition& condition);
    /// Returns the initial placement of bodies in a trial. Placements in later conditions replace
    /// those in earlier ones.
    std::vector<TaskPlan::StartPose> start_poses(
        std::initializer_list<const Condition*> conditions) const;
    /// Plans the placements, drives and motors of a state.
    void plan_state(const State& state, TaskPlan::PlannedState& out);

  private:
    void error(const Place& place, const char* key, const std::string& what,
               const std::string& remedy) {
        diagnostics.error(place, key, what, remedy);
    }
    const scene::Body& body(const Ref<scene::Body>& ref) const {
        return scene.bodies[static_cast<size_t>(ref.index)];
    }
    void check_placeable(const Ref<scene::Body>& body, const Place& place);
    void check_put(const StatePlace& place);
    void add_placement(const StatePlace& place, std::vector<TaskPlan::Placement>& placements);
    void add_drive(const DriveSpec& spec, TaskPlan::PlannedState& out);
    void add_motor(const MotorSpec& spec, TaskPlan::PlannedState& out);
    TaskPlan::StartPose start_pose(int index, const FormulaVec3& position) const;
    bool is_placed(int body) const;
    const scene::Joint* joint_of(const BodyPlace& place) const;
    int moved_by(const BodyPlace& place) const;
    void place_by_joint(const BodyPlace& place, TaskPlan::StartPose& start_pose) const;
    void hang(std::vector<TaskPlan::StartPose>& start_poses) const;
};

}  // namespace dihaptic::task
