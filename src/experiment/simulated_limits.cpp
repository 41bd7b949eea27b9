#include "experiment/simulated_limits.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

namespace dihaptic::experiment {
namespace {

constexpr const char* kRemedy =
    "Rehearse the order and the time of trials with it, and take no figure of it for people's.";

/// Whether the perturbation shows movements longer or shorter than they are.
bool scales(const PerturbationSpec& perturbation) {
    if (!perturbation.visual) return false;
    const auto& moves = perturbation.visual->moves;
    return std::find(moves.begin(), moves.end(), "proxies") != moves.end() &&
           !perturbation.visual->scale.isApprox(Vec3::Ones());
}

/// Whether a state asks a question: two keys or more.
bool asks(const TaskPlan::Stage& stage) {
    std::set<std::string> keys;
    for (const TaskPlan::Way& way : stage.ways) {
        if (way.exit.when == When::key) keys.insert(way.exit.key);
    }
    return keys.size() > 1;
}

void warn_of_fields(const TaskPlan& plan, std::vector<Problem>& out) {
    for (const PerturbationSpec& perturbation : plan.task.perturbations) {
        if (!perturbation.field) continue;
        out.push_back({Severity::warning, perturbation.place, perturbation.name,
                       "is a force field: simulated people (--simulate, rehearse) do not learn "
                       "forces, and answer what they see of it as a rotation",
                       kRemedy});
    }
}

void warn_of_answers(const TaskPlan& plan, std::vector<Problem>& out) {
    for (const ProcedureSpec& procedure : plan.task.procedures) {
        const auto named =
            std::find_if(plan.task.perturbations.begin(), plan.task.perturbations.end(),
                         [&](const PerturbationSpec& p) { return p.name == procedure.perturb; });
        if (named == plan.task.perturbations.end() || scales(*named)) continue;
        out.push_back({Severity::warning, procedure.place, procedure.name,
                       fmt::format("asks about '{}', which scales nothing that is shown: simulated "
                                   "people judge only whether a movement was shown longer than "
                                   "they made it, and their answers and threshold mean nothing",
                                   procedure.perturb),
                       kRemedy});
    }
    const bool lengths =
        std::any_of(plan.task.perturbations.begin(), plan.task.perturbations.end(), scales);
    if (lengths || !plan.task.procedures.empty()) return;
    for (size_t i = 0; i < plan.stages.size(); ++i) {
        if (!asks(plan.stages[i])) continue;
        const State& state = plan.task.states[i];
        out.push_back({Severity::warning, state.place, state.name,
                       "asks a question, and nothing is shown scaled: simulated people judge only "
                       "whether a movement was shown longer than they made it, and their answers "
                       "mean nothing",
                       kRemedy});
    }
}

void warn_of_buttons(const TaskPlan& plan, std::vector<Problem>& out) {
    for (size_t i = 0; i < plan.stages.size(); ++i) {
        for (const TaskPlan::Way& way : plan.stages[i].ways) {
            if (way.exit.when != When::button) continue;
            out.push_back({Severity::warning, way.exit.place, plan.task.states[i].name,
                           "waits for a button, which simulated people never press", kRemedy});
        }
    }
}

}  // namespace

std::vector<Problem> simulated_limits(const TaskPlan& plan) {
    std::vector<Problem> out;
    warn_of_fields(plan, out);
    warn_of_answers(plan, out);
    warn_of_buttons(plan, out);
    return out;
}

}  // namespace dihaptic::experiment
