#include "task/plan/names.h"

namespace dihaptic::task {
namespace {

/// Names of the things that loads can act on: bodies and, through their handles, fingers.
std::vector<std::string> things_of(const scene::Scene& scene) {
    std::vector<std::string> out = names_of(scene.bodies);
    for (const scene::Finger& finger : scene.fingers) out.push_back(finger.name);
    return out;
}

}  // namespace

Names::Names(const Task& task, const scene::Scene& scene)
    : known_({names_of(task.hands), "not a hand of the task"},
             {names_of(task.regions), "not a region"}, {names_of(scene.bodies), "not a body"},
             {names_of(recorded_joints(scene)), "not a joint of the scene"},
             {scene::finger_names(scene), "not a finger of the scene"},
             {things_of(scene), "neither a finger nor a body"},
             {names_of(task.states), "not a state"},
             {names_of(task.sounds), "not a sound of the task"},
             {names_of(task.conditions), "not a condition"},
             {names_of(task.perturbations), "not a perturbation"},
             {names_of(task.procedures), "not a procedure"},
             {names_of(task.variables), "not a variable"}) {}

}  // namespace dihaptic::task
