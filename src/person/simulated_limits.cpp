#include "person/simulated_limits.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

namespace dihaptic::person {
namespace {

constexpr const char* kRemedy =
    "Rehearse the order and the time of trials with it, and take no figure of it for people's.";

/// Whether the perturbation shows movements longer or shorter than they are.
bool scales(const task::PerturbationSpec& perturbation) {
    if (!perturbation.visual) return false;
    const auto& moves = perturbation.visual->moves;
    return std::find(moves.begin(), moves.end(), "proxies") != moves.end() &&
           !perturbation.visual->scale.isApprox(Vec3::Ones());
}

/// Whether a state asks a question: two keys or more.
bool asks_by_keys(const task::TaskPlan::Stage& stage) {
    std::set<std::string> keys;
    for (const task::TaskPlan::Way& way : stage.ways) {
        if (way.exit.when == task::When::key) keys.insert(way.exit.key);
    }
    return keys.size() > 1;
}

void warn_of_fields(const task::TaskPlan& plan, std::vector<Problem>& out) {
    for (const task::PerturbationSpec& perturbation : plan.task.perturbations) {
        if (!perturbation.field) continue;
        out.push_back({Severity::warning, perturbation.place, perturbation.name,
                       "is a force field: simulated people (--simulate, rehearse) do not learn "
                       "forces, and answer what they see of it as a rotation",
                       kRemedy});
    }
}

void warn_of_answers(const task::TaskPlan& plan, std::vector<Problem>& out) {
    for (const task::ProcedureSpec& procedure : plan.task.procedures) {
        const auto named = std::find_if(
            plan.task.perturbations.begin(), plan.task.perturbations.end(),
            [&](const task::PerturbationSpec& p) { return p.name == procedure.perturb; });
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
        if (!asks_by_keys(plan.stages[i])) continue;
        const task::State& state = plan.task.states[i];
        out.push_back({Severity::warning, state.place, state.name,
                       "asks a question, and nothing is shown scaled: simulated people judge only "
                       "whether a movement was shown longer than they made it, and their answers "
                       "mean nothing",
                       kRemedy});
    }
}

void warn_of_buttons(const task::TaskPlan& plan, std::vector<Problem>& out) {
    for (size_t i = 0; i < plan.stages.size(); ++i) {
        for (const task::TaskPlan::Way& way : plan.stages[i].ways) {
            if (way.exit.when != task::When::button) continue;
            out.push_back({Severity::warning, way.exit.place, plan.task.states[i].name,
                           "waits for a button, which simulated people never press", kRemedy});
        }
    }
}

}  // namespace

std::vector<Problem> simulated_limits(const task::TaskPlan& plan) {
    std::vector<Problem> out;
    warn_of_fields(plan, out);
    warn_of_answers(plan, out);
    warn_of_buttons(plan, out);
    return out;
}

}  // namespace dihaptic::person
