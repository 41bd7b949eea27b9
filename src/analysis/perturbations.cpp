#include "analysis/perturbations.h"

#include "base/field_reader.h"
#include "base/regular_file.h"
#include "task/task.h"

namespace dihaptic::analysis {
namespace {

/// Description of the perturbation if its learning is not measured; otherwise "".
std::string what_of(const task::PerturbationSpec& perturbation) {
    if (perturbation.field) {
        const task::FieldKind kind = perturbation.field->kind;
        return kind == task::FieldKind::channel
                   ? "a force channel"
                   : "a force field (" + std::string(enum_name(kind)) + ")";
    }
    if (!perturbation.body) return "";
    const Vec3& scale = perturbation.body->mass_scale;
    return scale == Vec3::Constant(scale.x()) ? "" : "a mass that differs by direction";
}

void collect(const std::vector<task::PerturbationSpec>& perturbations, Unmeasured& out) {
    for (const task::PerturbationSpec& perturbation : perturbations) {
        const std::string what = what_of(perturbation);
        if (!perturbation.name.empty() && !what.empty()) out[perturbation.name] = what;
    }
}

}  // namespace

Unmeasured unmeasured_perturbations(const std::string& task_file) {
    if (!is_there(task_file)) return {};
    task::Task task;
    try {
        Diagnostics ignored(UnknownKeys::are_left_out);  // what can be read of it tells enough
        read_fields(task, read_yaml(task_file), ignored);
    } catch (const Error&) {
        return {};
    }
    Unmeasured out;
    collect(task.perturbations, out);
    // with these they are replaced
    for (const auto* list : {&task.rounds, &task.conditions}) {
        for (const task::Condition& condition : *list) collect(condition.perturbations, out);
    }
    return out;
}

}  // namespace dihaptic::analysis
