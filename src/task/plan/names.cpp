#include "task/plan/names.h"

namespace dihaptic::task {
namespace {

/// Loads act on bodies and, by their handles, on fingers.
std::vector<std::string> things_of(const scene::Scene& scene) {
    std::vector<std::string> out = names_of(scene.bodies);
    for (const scene::Finger& finger : scene.fingers) out.push_back(finger.name);
    return out;
}

}  // namespace

Names::Names(const Task& task, const scene::Scene& scene)
    : known_({names_of(task.regions), "no region"}, {names_of(scene.bodies), "no body"},
             {names_of(recorded_joints(scene)), "no joint of the scene"},
             {scene::finger_names(scene), "none of the scene's fingers"},
             {things_of(scene), "no finger or body"}, {names_of(task.states), "no state"},
             {names_of(task.sounds), "no sound of the task"},
             {names_of(task.conditions), "no condition"},
             {names_of(task.perturbations), "no perturbation"},
             {names_of(task.procedures), "no procedure"},
             {names_of(task.variables), "no variable"}) {}

}  // namespace dihaptic::task
