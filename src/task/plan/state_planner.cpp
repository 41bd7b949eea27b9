#include "task/plan/state_planner.h"

#include <fmt/format.h>

#include <algorithm>

#include "task/file/hed.h"
#include "task/plan/exit_condition.h"
#include "task/plan/question_planner.h"

namespace dihaptic::task {
namespace {

constexpr const char* kSkipped = "skipped";

class StatePlanner : Planning {
  public:
    StatePlanner(const Planning& given, BodyPlanner& bodies, SeenPlanner& seen)
        : Planning(given), bodies_(bodies), seen_(seen) {}

    TaskPlan::PlannedState planned(const State& state) {
        TaskPlan::PlannedState out;
        const bool titled = state.message.empty() && state.form;
        out.message =
            seen_.text(titled ? state.form->title : state.message, state.place, "message");
        seen_.plan_state(state, out);
        out.marker = state.marker;
        check_hed(state.hed, state.place, diagnostics);
        for (const int i : state.sounds.indices) out.sounds |= sound(i, state.place, "sounds");
        out.interval = state.interval;
        out.questions = plan_questions(*this, seen_, state);
        bodies_.plan_state(state, out);
        for (const Exit& exit : state.exits) out.transitions.push_back(transition(exit));
        for (const HandStep& step : state.hand) {
            TaskPlan::Step& added = out.hand.emplace_back(TaskPlan::Step{step});
            if (!step.fingers.empty()) added.fingers = fingers_of(step.fingers);
        }
        if (state.exits.empty()) {
            error(state.place, state.name, "never ends",
                  "Add exits, e.g. - { when: time, after_s: 5, outcome: too late, redo: yes }.");
        }
        return out;
    }

  private:
    void error(const Place& place, const std::string& key, const std::string& what,
               const std::string& remedy) {
        diagnostics.error(place, key, what, remedy);
    }

    /// Returns a mask with the bit of the sound that starts at `where`.
    uint32_t sound(int index, const Place& where, const char* key) {
        if (index < 0 || index >= TaskPlan::kMostSounds) return 0;
        if ((plan.throughout >> index & 1u) != 0)
            error(where, key,
                  fmt::format("'{}' lasts throughout the session",
                              plan.task.sounds[static_cast<size_t>(index)].name),
                  "Leave it out here, or write lasts: once or lasts: state.");
        return 1u << index;
    }

    /// Returns a mask with the bit of the sound that the exit starts.
    uint32_t sound(const Exit& exit) {
        const uint32_t out = sound(exit.sound.index, exit.place, "sound");
        if ((out & plan.going_on) != 0)
            error(exit.place, "sound",
                  fmt::format("'{}' lasts as long as a state, but an exit has no duration",
                              exit.sound),
                  "Name it in the next state, or write lasts: once.");
        return out;
    }

    TaskPlan::Transition transition(const Exit& exit) {
        TaskPlan::Transition out;
        out.exit = exit;
        if (exit.has(WhenRow::finger) && !exit.finger.empty())
            out.finger = names.find<scene::Finger>(exit.finger, exit.place, "finger", diagnostics);
        out.condition = plan_condition(*this, bodies_, exit);
        const int transitions = !exit.to.empty() + !exit.outcome.empty() + (exit.chooses > 0);
        if (transitions != 1) {
            error(exit.place, "to",
                  transitions == 0 ? "leads nowhere" : "has more than one destination",
                  "Give it exactly one of 'to' (a state), 'outcome' (the trial's result) and "
                  "'chooses' (an interval).");
        }
        if (exit.ends_session && exit.outcome.empty())
            error(exit.place, "ends_session", "belongs to an exit with an outcome",
                  "Give the exit an outcome.");
        if (exit.chooses > 0) out.outcome = choice(exit);
        if (!exit.outcome.empty()) out.outcome = outcome(exit);
        check_hed(exit.hed, exit.place, diagnostics);
        if (!exit.hed.empty() && exit.outcome.empty())
            error(exit.place, "hed", "belongs to an exit with an outcome",
                  "Give the tags to the next state.");
        out.feedback = seen_.text(exit.feedback, exit.place, "feedback");
        out.sounds = sound(exit);
        return out;
    }

    /// Adds both possible outcomes of a choice and returns one of them. The trial determines which
    /// of the two applies.
    int choice(const Exit& exit) {
        if (plan.comparison < 0)
            error(exit.place, "chooses", "no state has an interval that can be chosen",
                  "Add interval: 1 and interval: 2 to states, or give the exit an outcome.");
        Exit chosen = exit;
        chosen.outcome = kStandard;
        plan.chose_standard = outcome(chosen);
        chosen.outcome = kComparison;
        return plan.chose_comparison = outcome(chosen);
    }

    int outcome(const Exit& exit) {
        if (exit.outcome == kSkipped)
            error(exit.place, "outcome",
                  fmt::format("'{}' is reserved for trials that the operator skips", kSkipped),
                  "Give the outcome another name.");
        for (size_t i = 0; i < plan.outcomes.size(); ++i) {
            if (plan.outcomes[i].name != exit.outcome) continue;
            if (plan.outcomes[i].ends_session != exit.ends_session) {
                error(exit.place, "outcome",
                      fmt::format("'{}' ends the session after one exit, but not after another",
                                  exit.outcome),
                      "Give the two outcomes different names.");
            }
            if (plan.outcomes[i].hed != exit.hed) {
                error(exit.place, "hed",
                      fmt::format("'{}' has different tags after another exit", exit.outcome),
                      "Give the two outcomes different names, or the same tags.");
            }
            if (plan.outcomes[i].redo != exit.redo) {
                error(exit.place, "redo",
                      fmt::format("trials that end with '{}' are repeated after one exit, but not "
                                  "after another",
                                  exit.outcome),
                      "Give the two outcomes different names.");
            }
            return static_cast<int>(i);
        }
        plan.outcomes.push_back({exit.outcome, exit.redo, exit.ends_session, exit.hed});
        return static_cast<int>(plan.outcomes.size()) - 1;
    }

    BodyPlanner& bodies_;
    SeenPlanner& seen_;
};

/// Checks that every state can be reached from a state in which trials begin, and that every state
/// leads to the end of the trial.
void check_ways(const TaskPlan& plan, Diagnostics& diagnostics) {
    const size_t n = plan.states.size();
    std::vector<char> reached(n, 0);
    std::vector<char> leaves(n, 0);
    if (n > 0) reached[0] = 1;
    for (const Block& block : plan.task.blocks) {
        if (block.begins.index >= 0) reached[static_cast<size_t>(block.begins.index)] = 1;
    }
    for (size_t round = 0; round < n; ++round) {
        for (size_t i = 0; i < n; ++i) {
            for (const TaskPlan::Transition& transition : plan.states[i].transitions) {
                if (transition.outcome >= 0) leaves[i] = 1;
                if (transition.exit.to.index < 0) continue;
                const auto to = static_cast<size_t>(transition.exit.to.index);
                if (reached[i]) reached[to] = 1;
                if (leaves[to]) leaves[i] = 1;
            }
        }
    }
    for (size_t i = 0; i < n; ++i) {
        const State& state = plan.task.states[i];
        if (!reached[i]) {
            diagnostics.warning(state.place, state.name, "no exit leads to this state",
                                "Remove it, or make an exit lead to it.");
        } else if (!leaves[i] && !state.exits.empty()) {
            diagnostics.error(state.place, state.name,
                              "no sequence of exits leads from here to an outcome",
                              "Give one of its exits an outcome.");
        }
    }
}

}  // namespace

scene::FingerSet fingers_of(const RefList<scene::Finger>& names) {
    scene::FingerSet out;
    for (const int i : names.indices) out.set(static_cast<size_t>(i));
    return out;
}

void plan_states(const Planning& given, BodyPlanner& bodies, SeenPlanner& seen) {
    TaskPlan& plan = given.plan;
    StatePlanner planner(given, bodies, seen);
    for (const State& state : plan.task.states) plan.states.push_back(planner.planned(state));
    plan.skipped = static_cast<int>(plan.outcomes.size());
    plan.outcomes.push_back({kSkipped});
    check_ways(plan, given.diagnostics);
}

}  // namespace dihaptic::task
