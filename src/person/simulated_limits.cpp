#include "person/simulated_limits.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <set>

namespace dihaptic::person {
namespace {

constexpr const char* kRemedy =
    "Rehearse the order and timing of trials with simulated people, but do not treat their figures "
    "as human data.";

/// Whether the perturbation scales movements on the display.
bool scales(const task::PerturbationSpec& perturbation) {
    if (!perturbation.visual) return false;
    const auto& moves = perturbation.visual->moves;
    return std::find(moves.begin(), moves.end(), "proxies") != moves.end() &&
           perturbation.visual->scale != FormulaVec3{1, 1, 1};
}

/// Number of different keys for which a state waits. Two or more keys form a question.
size_t keys_of(const task::TaskPlan::PlannedState& planned) {
    std::set<std::string> keys;
    for (const task::TaskPlan::Transition& transition : planned.transitions) {
        if (transition.exit.when == task::When::key) keys.insert(transition.exit.key);
    }
    return keys.size();
}

/// The perturbations for which `has` holds, each name once. Considers the task's perturbations and
/// those that conditions and rounds replace them with.
template <class F>
std::vector<const task::PerturbationSpec*> perturbations_with(const task::TaskPlan& plan,
                                                              const F& has) {
    std::vector<const task::PerturbationSpec*> out;
    const auto add = [&](const std::vector<task::PerturbationSpec>& specs) {
        for (const task::PerturbationSpec& spec : specs) {
            const auto same = [&](const auto* other) { return other->name == spec.name; };
            if (has(spec) && std::ranges::none_of(out, same)) out.push_back(&spec);
        }
    };
    add(plan.task.perturbations);
    for (const auto* list : {&plan.task.rounds, &plan.task.conditions}) {
        for (const task::Condition& condition : *list) add(condition.perturbations);
    }
    return out;
}

bool reaches(const task::TaskPlan::PlannedState& planned) {
    return std::any_of(planned.hand.begin(), planned.hand.end(),
                       [](const task::TaskPlan::Step& step) { return step.step.reach.index >= 0; });
}

void warn_of_fields(const task::TaskPlan& plan, std::vector<Problem>& out) {
    if (std::any_of(plan.states.begin(), plan.states.end(), reaches)) return;
    for (const task::PerturbationSpec& perturbation : plan.task.perturbations) {
        const auto& loads = perturbation.all_loads();
        const auto links = [](const task::LoadSpec& load) {
            return load.kind == task::LoadKind::link;
        };
        if (std::all_of(loads.begin(), loads.end(), links)) continue;
        out.push_back({Severity::warning, perturbation.place, perturbation.name,
                       "is a force field, which simulated people (--simulate, rehearse) learn only "
                       "in hand steps that reach a region, but there is no such step",
                       kRemedy});
    }
}

void warn_of_delays(const task::TaskPlan& plan, std::vector<Problem>& out) {
    const auto is_late = [](const task::PerturbationSpec& perturbation) {
        return perturbation.visual && !(perturbation.visual->delay == Formula{0});
    };
    for (const task::PerturbationSpec* perturbation : perturbations_with(plan, is_late)) {
        out.push_back({Severity::warning, perturbation->place, perturbation->name,
                       "is shown late: simulated people see it late, but learn from it as much as "
                       "without the delay, whereas real people learn less",
                       kRemedy});
    }
}

void warn_of_shifts(const task::TaskPlan& plan, std::vector<Problem>& out) {
    const auto shifts = [](const task::PerturbationSpec& perturbation) {
        return perturbation.visual && !(perturbation.visual->shift == FormulaVec3{});
    };
    for (const task::PerturbationSpec* perturbation : perturbations_with(plan, shifts)) {
        out.push_back(
            {Severity::warning, perturbation->place, perturbation->name,
             "shifts what is shown: simulated people correct a shift about as much as "
             "people do if they see the hand all the way; if it is shown only later in "
             "the reach, they correct too much, and mistake the shift for a rotation, so that "
             "changes over trials are arbitrary",
             kRemedy});
    }
}

void warn_of_steps(const task::TaskPlan& plan, std::vector<Problem>& out) {
    const auto bodies = static_cast<int>(plan.bodies);
    const auto steps = [&](const task::PerturbationSpec& perturbation) {
        return std::ranges::any_of(perturbation.all_loads(), [&](const task::LoadSpec& load) {
            return load.kind == task::LoadKind::constant &&
                   std::ranges::any_of(load.on.indices, [&](int thing) { return thing >= bodies; });
        });
    };
    for (const task::PerturbationSpec* perturbation : perturbations_with(plan, steps)) {
        out.push_back({Severity::warning, perturbation->place, perturbation->name,
                       "pushes the hand with a constant force: simulated people yield to it like a "
                       "spring, without reflexes that depend on their goal, so that responses to "
                       "it are arbitrary",
                       kRemedy});
    }
}

void warn_of_links(const task::TaskPlan& plan, std::vector<Problem>& out) {
    const auto links = [](const task::PerturbationSpec& perturbation) {
        return std::ranges::any_of(perturbation.all_loads(), [](const task::LoadSpec& load) {
            return load.kind == task::LoadKind::link;
        });
    };
    for (const task::PerturbationSpec* perturbation : perturbations_with(plan, links)) {
        out.push_back({Severity::warning, perturbation->place, perturbation->name,
                       "is a link, for which there is no model: simulated people do not learn it, "
                       "and neither leads nor follows through it",
                       kRemedy});
    }
}

void warn_of_thresholds(const task::TaskPlan& plan, std::vector<Problem>& out) {
    for (const task::ProcedureSpec& procedure : plan.task.procedures) {
        const auto& names = procedure.perturb;
        const bool scaled = std::any_of(
            plan.task.perturbations.begin(), plan.task.perturbations.end(),
            [&](const task::PerturbationSpec& p) {
                return scales(p) && std::find(names.begin(), names.end(), p.name) != names.end();
            });
        if (scaled && procedure.level.empty()) continue;
        const std::string what = procedure.level.empty()
                                     ? fmt::format("'{}', which does not scale the display",
                                                   fmt::join(names, task::kBetweenNames))
                                     : procedure.level;
        out.push_back({Severity::warning, procedure.place, procedure.name,
                       fmt::format("asks about {}: simulated people judge only whether a movement "
                                   "was shown longer than they made it, and their answers and "
                                   "threshold are arbitrary",
                                   what),
                       kRemedy});
    }
}

void warn_of_answers(const task::TaskPlan& plan, std::vector<Problem>& out) {
    const bool lengths =
        std::any_of(plan.task.perturbations.begin(), plan.task.perturbations.end(), scales);
    for (size_t i = 0; i < plan.states.size(); ++i) {
        const size_t keys = keys_of(plan.states[i]);
        if (keys < 2) continue;
        const task::State& state = plan.task.states[i];
        if (keys > 2) {
            out.push_back({Severity::warning, state.place, state.name,
                           fmt::format("asks for one of {} keys: simulated people judge only "
                                       "whether a movement was shown longer than they made it, "
                                       "press the first key for yes and the second for no, and "
                                       "their answers are arbitrary",
                                       keys),
                           kRemedy});
        } else if (!lengths && plan.task.procedures.empty()) {
            out.push_back(
                {Severity::warning, state.place, state.name,
                 "asks a question, but no display is scaled: simulated people judge only whether a "
                 "movement was shown longer than they made it, and their answers are arbitrary",
                 kRemedy});
        }
    }
}

void warn_of_ratings(const task::TaskPlan& plan, std::vector<Problem>& out) {
    for (const task::State& state : plan.task.states) {
        const auto random = [](const task::AskSpec& ask) { return !ask.simulated; };
        const auto ask = std::ranges::find_if(state.questions(), random);
        if (ask == state.questions().end()) continue;
        out.push_back({Severity::warning, ask->place, ask->name,
                       "is a rating, for which there is no model: the answers of simulated people "
                       "are arbitrary",
                       kRemedy});
    }
}

void warn_of_pushes(const task::TaskPlan& plan, std::vector<Problem>& out) {
    for (const task::State& state : plan.task.states) {
        const auto pushes = [](const task::MotorSpec& motor) { return !motor.push.empty(); };
        const auto motor = std::ranges::find_if(state.motors, pushes);
        if (motor == state.motors.end()) continue;
        out.push_back(
            {Severity::warning, motor->place, state.name,
             "pushes with a motor: simulated people do not judge forces, so they respond in the "
             "same way whatever the force, and measures of their response are arbitrary",
             kRemedy});
        return;  // one warning is enough, because it concerns the people, not this motor
    }
}

void warn_of_buttons(const task::TaskPlan& plan, std::vector<Problem>& out) {
    for (size_t i = 0; i < plan.states.size(); ++i) {
        for (const task::TaskPlan::Transition& transition : plan.states[i].transitions) {
            const bool reads = transition.exit.condition.find(".buttons") != std::string::npos;
            if (transition.exit.when != task::When::button && !reads) continue;
            out.push_back({Severity::warning, transition.exit.place, plan.task.states[i].name,
                           "waits for a button, which simulated people never press", kRemedy});
        }
    }
}

}  // namespace

std::vector<Problem> simulated_limits(const task::TaskPlan& plan) {
    std::vector<Problem> out;
    warn_of_fields(plan, out);
    warn_of_delays(plan, out);
    warn_of_shifts(plan, out);
    warn_of_steps(plan, out);
    warn_of_links(plan, out);
    warn_of_thresholds(plan, out);
    warn_of_answers(plan, out);
    warn_of_ratings(plan, out);
    warn_of_pushes(plan, out);
    warn_of_buttons(plan, out);
    return out;
}

}  // namespace dihaptic::person
