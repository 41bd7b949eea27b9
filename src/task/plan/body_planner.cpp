#include "task/plan/body_planner.h"

#include <fmt/format.h>

#include <algorithm>

namespace dihaptic::task {
namespace {

/// Height and spacing at which bodies removed by a state are placed: beyond any plane, and far from
/// each other [m].
constexpr double kAway = 1000;
constexpr double kApart = 100;

}  // namespace

void BodyPlanner::check_movable(const Ref<scene::Body>& ref, const Place& place, const char* key) {
    if (names.need(ref, place, key, diagnostics) >= 0 && !body(ref).moves_at_all())
        error(place, key, fmt::format("'{}' cannot move", std::string(ref)),
              "Name a movable body.");
}

void BodyPlanner::check_placeable(const Ref<scene::Body>& ref, const Place& place) {
    if (ref.index >= 0 && body(ref).shape.kind == scene::ShapeKind::plane)
        error(place, "body",
              fmt::format("'{}' is a plane, which cannot be placed", std::string(ref)),
              "Name another body, e.g. a box.");
}

void BodyPlanner::check(const Condition& condition) {
    if (!condition.object.empty()) check_movable(condition.object, condition.place, "object");
    for (const BodyPlace& place : condition.places) {
        check_joint(place, scene, diagnostics);
        if (place.joint.empty()) check_placeable(place.body, place.place);
        if (place.body.index >= 0 &&
            std::ranges::count(plan.task.stays.indices, place.body.index) > 0)
            error(place.place, "body",
                  fmt::format("'{}' is placed, but the task's 'stays' lists it", place.body),
                  "Keep one of the two.");
    }
}

void BodyPlanner::plan_state(const State& state, TaskPlan::PlannedState& out) {
    for (const StatePlace& place : state.places) add_placement(place, out.placements);
    for (const DriveSpec& drive : state.drives) add_drive(drive, out);
    for (const MotorSpec& motor : state.motors) add_motor(motor, out);
}

void BodyPlanner::check_put(const StatePlace& place) {
    const scene::Body& body = this->body(place.body);
    if (!place.position && !place.velocity && !place.held && !place.removed)
        error(place.place, "position", "is missing, and so is any other key for the body",
              "Add position_mm, velocity_mm_s, held: yes or removed: yes.");
    if (place.velocity && (place.held || place.removed || body.fixed || body.driven))
        error(place.place, "velocity", "is only for a body that is free to move",
              "Leave out 'velocity', or leave out 'held' and 'removed', or make the body movable "
              "in the scene.");
    if (place.removed && (place.position || place.held))
        error(place.place, "removed", "cannot be combined with 'position' or 'held'",
              "Leave out position_mm and 'held'.");
    if (place.held && body.fixed)
        error(place.place, "held",
              fmt::format("'{}' is fixed and stays in place anyway", place.body), "Leave it out.");
}

void BodyPlanner::add_placement(const StatePlace& place,
                                std::vector<TaskPlan::Placement>& placements) {
    const int index = place.body.index;
    if (index < 0) return;
    check_placeable(place.body, place.place);
    check_put(place);
    for (const TaskPlan::Placement& put : placements) {
        if (put.pose.body == index)
            error(place.place, "body", fmt::format("'{}' is placed twice", place.body),
                  "Keep one of the two.");
    }
    const Vec3 away(kApart * index, 0, kAway);
    const FormulaVec3 position =
        place.removed ? as_formula(away)
                      : place.position.value_or(as_formula(body(place.body).position));
    TaskPlan::Placement& put = placements.emplace_back(TaskPlan::Placement{
        start_pose(index, position), place.position || place.removed, place.held || place.removed});
    if (place.velocity) put.pose.velocity = *place.velocity;
}

void BodyPlanner::add_drive(const DriveSpec& spec, TaskPlan::PlannedState& out) {
    const int index = spec.body.index;
    if (index < 0) return;
    const scene::Body& driven = body(spec.body);
    if (!driven.driven && !driven.moves_at_all())
        error(spec.place, "body", fmt::format("'{}' is fixed in the scene", spec.body),
              "Write driven: yes there instead of fixed: yes.");
    const auto same = [&](const auto& other) {
        if constexpr (requires { other.pose; })
            return other.pose.body == index && other.stays;
        else
            return other.body() == index;
    };
    if (std::any_of(out.drives.begin(), out.drives.end(), same) ||
        std::any_of(out.placements.begin(), out.placements.end(), same))
        error(spec.place, "body", fmt::format("'{}' is driven or held twice", spec.body),
              "Keep one of the two.");
    out.drives.emplace_back(spec, index, plan.quantities, diagnostics);
}

void BodyPlanner::add_motor(const MotorSpec& spec, TaskPlan::PlannedState& out) {
    const int index = spec.joint.index;
    if (index < 0) return;
    const scene::Joint& joint = scene.joints[static_cast<size_t>(index)];
    if (!joint.has_coordinate()) {
        error(spec.place, "joint",
              fmt::format("'{}' has no axis for a motor: it is a {} joint", joint.name,
                          enum_name(joint.kind)),
              fmt::format("Name {}.", scene::kinds_that(&scene::JointKindRow::has_coordinate)));
        return;
    }
    if (std::any_of(out.motors.begin(), out.motors.end(),
                    [&](const Motor& other) { return other.joint() == index; }))
        error(spec.place, "joint", fmt::format("'{}' has two motors", joint.name),
              "Keep one motor: a single motor can both follow a course and push.");
    if (out.motors.size() == frame::TaskFrame::kMostMotors)
        error(spec.place, "joint", fmt::format("there are more than {} motors", out.motors.size()),
              "Leave some out.");
    out.motors.emplace_back(spec, joint, index, plan.quantities, diagnostics);
}

TaskPlan::StartPose BodyPlanner::start_pose(int index, const FormulaVec3& position) const {
    const scene::Body& body = scene.bodies[static_cast<size_t>(index)];
    Pose X_WB = body.pose();
    X_WB.p = value(position);
    return {index, X_WB, scene::bounds(body.shape), position};
}

/// Whether any trial moves the body away from its position in the scene.
bool BodyPlanner::is_placed(int body) const {
    const auto among = [&](const auto& places) {
        return std::any_of(places.begin(), places.end(),
                           [&](const auto& place) { return place.body.index == body; });
    };
    const auto any = [&](const auto& list) {
        return std::any_of(list.begin(), list.end(),
                           [&](const auto& item) { return among(item.places); });
    };
    return any(plan.task.conditions) || any(plan.task.rounds) || any(plan.task.states);
}

std::vector<TaskPlan::StartPose> BodyPlanner::start_poses(
    std::initializer_list<const Condition*> conditions) const {
    std::vector<TaskPlan::StartPose> out;
    for (size_t i = 0; i < scene.bodies.size(); ++i) {
        const scene::Body& body = scene.bodies[i];
        if (!body.moves_at_all() && !body.driven && !is_placed(static_cast<int>(i))) continue;
        if (std::ranges::count(plan.task.stays.indices, static_cast<int>(i)) > 0) continue;
        FormulaVec3 position = as_formula(body.position);
        FormulaVec3 velocity{};
        const BodyPlace* by_joint = nullptr;
        for (const Condition* condition : conditions) {
            for (const BodyPlace& place : condition->places) {
                if (place.body.index == static_cast<int>(i) && place.position) {
                    position = *place.position;
                    velocity = place.velocity.value_or(FormulaVec3{});
                    by_joint = nullptr;
                }
                if (moved_by(place) == static_cast<int>(i)) by_joint = &place;
            }
        }
        TaskPlan::StartPose& added = out.emplace_back(start_pose(static_cast<int>(i), position));
        added.velocity = velocity;
        if (by_joint != nullptr) place_by_joint(*by_joint, added);
    }
    hang(out);
    return out;
}

const scene::Joint* BodyPlanner::joint_of(const BodyPlace& place) const {
    if (place.joint.index < 0) return nullptr;
    const scene::Joint& joint = scene.joints[static_cast<size_t>(place.joint.index)];
    return joint.row().has_axis() ? &joint : nullptr;
}

/// Returns the index of the body placed by a joint, or -1 if the placement does not use a joint.
int BodyPlanner::moved_by(const BodyPlace& place) const {
    const scene::Joint* const joint = joint_of(place);
    return joint == nullptr ? -1 : scene.find(joint->between.back());
}

void BodyPlanner::place_by_joint(const BodyPlace& place, TaskPlan::StartPose& start_pose) const {
    const scene::Joint& joint = *joint_of(place);
    start_pose.joint = on_joint(scene, joint);
    start_pose.coordinate = (joint.slides() ? place.displacement : place.angle).value_or(0.0);
    start_pose.rate = joint.slides() ? place.speed : place.rate;
}

/// Adds the bodies attached to a body that a joint places, since they move with it, and sorts all
/// start poses so that each body follows the body to which it is attached.
void BodyPlanner::hang(std::vector<TaskPlan::StartPose>& start_poses) const {
    const auto start_of = [&](int body) {
        return std::find_if(start_poses.begin(), start_poses.end(),
                            [body](const auto& start_pose) { return start_pose.body == body; });
    };
    std::vector<int> ordered;
    for (const TaskPlan::StartPose& start_pose : start_poses) {
        if (start_pose.joint) ordered.push_back(start_pose.body);
    }
    for (size_t i = 0; i < ordered.size(); ++i) {
        for (const scene::Joint& joint : scene.joints) {
            if (joint.between.size() < 2 || scene.find(joint.between[0]) != ordered[i]) continue;
            const auto second = start_of(scene.find(joint.between[1]));
            if (second == start_poses.end()) continue;
            if (!second->joint) {
                second->joint = on_joint(scene, joint);
                ordered.push_back(second->body);
            }
        }
    }
    // number of joints between the body and the first body that is not placed by a joint
    const auto depth = [&](const TaskPlan::StartPose& start_pose) {
        size_t out = 0;
        for (auto at = start_of(start_pose.body);
             at != start_poses.end() && at->joint && out < start_poses.size();
             at = start_of(at->joint->first))
            ++out;
        return out;
    };
    std::vector<std::pair<size_t, TaskPlan::StartPose>> by_depth;
    for (const TaskPlan::StartPose& start_pose : start_poses)
        by_depth.emplace_back(depth(start_pose), start_pose);
    std::stable_sort(by_depth.begin(), by_depth.end(),
                     [](const auto& a, const auto& b) { return a.first < b.first; });
    for (size_t i = 0; i < start_poses.size(); ++i) start_poses[i] = by_depth[i].second;
}

}  // namespace dihaptic::task
