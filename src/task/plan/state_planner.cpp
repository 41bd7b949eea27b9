#include "task/plan/state_planner.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "task/file/hed.h"
#include "task/plan/levels.h"

namespace dihaptic::task {
namespace {

constexpr const char* kSkipped = "skipped";

/// Returns a name in the notation used in expressions.
std::string quoted(const std::string& name) {
    std::string out = "\"";
    for (const char c : name) {
        if (c == '"' || c == '\\') out += '\\';
        out += c;
    }
    return out + '"';
}

/// Returns a number in a condition, in the notation used in expressions.
std::string as_expression(const Formula& number, const TaskPlan& plan, const char* unit) {
    if (number.index < 0) return fmt::format("{}", number.value);
    const CompiledFormula& compiled = plan.formulas[static_cast<size_t>(number.index)];
    if (compiled.expression.dimension() != Dimension{}) return fmt::format("({})", number.text);
    return fmt::format("({}) * {} {}", number.text, number.to_si, unit);
}

/// Returns an expression that is equivalent to a condition of the table, or "" if no expression is.
std::string as_expression(const Exit& exit, const TaskPlan& plan) {
    const std::string who = quoted(exit.what.empty() ? exit.finger : exit.what);
    const std::string body = quoted(exit.body);
    switch (exit.when) {
        case When::inside:
        case When::outside:
            return fmt::format("{}({}{}, {})", enum_name(exit.when), who,
                               exit.shown ? ".shown" : "", quoted(exit.region));
        case When::touched:
        case When::released:
        case When::gripped:
            return fmt::format("{}({}, {})", enum_name(exit.when), body, who);
        case When::lifted:
            return fmt::format("lifted({}, {})", body, as_expression(exit.height, plan, "m"));
        case When::still:
            return fmt::format("still({}, {})", who, as_expression(exit.speed, plan, "m_s"));
        case When::expression:
            return exit.condition;
        default:
            return "";
    }
}

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
        ask(state, out.questions);
        check_answered(state);
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
               const std::string& remedy, std::vector<Choice> choices = {}) {
        diagnostics.error(place, key, what, remedy, std::move(choices));
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

    void ask(const State& state, TaskPlan::Questions& out) {
        if (state.form && state.ask)
            error(state.place, "ask", "is given together with a form",
                  "Make it an item of the form, or ask in another state.");
        if (state.form) {
            check(*state.form, diagnostics);
            out.is_form = true;
            out.confirm = seen_.confirmation(state);
        } else if (state.ask) {
            check(*state.ask, diagnostics);
            if (state.ask->optional)
                error(state.ask->place, "optional", "belongs to the items of a form",
                      "Add another exit instead, e.g. by time.");
        }
        size_t number = 0;
        for (const AskSpec& ask : state.questions()) check_same(ask);
        for (const AskSpec& ask : state.questions())
            out.items.push_back({question(ask), seen_.question(ask, ++number, state)});
    }

    Question question(const AskSpec& ask) {
        const std::vector<std::string> asked = names_of(questions_of(plan.task));
        const auto index = std::find(asked.begin(), asked.end(), ask.name) - asked.begin();
        Question out;
        out.least = ask.least();
        out.most = ask.most();
        out.whole = ask.whole();
        out.optional = ask.optional;
        out.simulated = ask.simulated;
        out.by = ask.by;
        out.variable = plan.task.variables.size() + plan.levels.size() + static_cast<size_t>(index);
        out.si = split_unit(ask.name).si;
        if (ask.by == AnswerBy::cursor && ask.between.indices.size() == 2) {
            out.from = ask.between.indices[0];
            out.to = ask.between.indices[1];
        }
        return out;
    }

    /// Checks that a question asked by several states is the same in all of them, because it has
    /// only one column.
    void check_same(const AskSpec& ask) {
        for (const AskSpec& known : questions_of(plan.task)) {
            if (known.name != ask.name) continue;
            if (known.scale == ask.scale && known.least() == ask.least() &&
                known.most() == ask.most())
                return;
            error(ask.place, "name",
                  fmt::format("'{}' is asked on a different scale in another state", ask.name),
                  "Give one of the two questions another name.");
        }
    }

    void check_answered(const State& state) {
        const auto confirms = [](const Exit& exit) { return exit.when == When::answered; };
        if (state.form && std::ranges::none_of(state.exits, confirms))
            error(state.place, "exits", "do not include the form's confirmation",
                  "Add e.g. - { when: answered, outcome: filled }.");
        for (const Exit& exit : state.exits) {
            if (exit.when != When::answered) continue;
            if (!state.ask && !state.form) {
                error(exit.place, "when", "the state does not ask for a number",
                      "Add e.g. ask: { name: heaviness, scale: numbers, from: 1, to: 9 }.");
            } else if (state.ask && state.ask->by == AnswerBy::cursor) {
                error(exit.place, "when", "an answer by cursor is available at all times",
                      "Use a condition that confirms the answer, e.g. when: still, hold_s: 1.");
            }
            if (exit.hold != 0)
                error(exit.place, "hold", "an answer has no duration", "Leave it out.");
        }
    }

    TaskPlan::Transition transition(const Exit& exit) {
        TaskPlan::Transition out;
        out.exit = exit;
        if (exit.has(WhenRow::finger) && !exit.finger.empty())
            out.finger = names.find<scene::Finger>(exit.finger, exit.place, "finger", diagnostics);
        out.condition = condition(exit);
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

    Expression condition(const Exit& exit) {
        const size_t before = diagnostics.problems().size();
        check_condition(exit);
        if (exit.when == When::expression) check_word(exit);
        const std::string text = as_expression(exit, plan);
        const bool named = (!exit.has(WhenRow::region) || exit.region.index >= 0) &&
                           (!exit.has(WhenRow::body) || exit.body.index >= 0);
        if (text.empty() || !named || diagnostics.problems().size() > before) return {};
        Expression out =
            Expression::compile(text, plan.quantities, exit.place, "when", diagnostics);
        if (!out.empty() && out.type() != Expression::Type::truth)
            error(exit.place, "when", fmt::format("'{}' is not a condition", text),
                  fmt::format("Compare it with a value, e.g. {} > 2.", text));
        return out;
    }

    /// Reports a single word that is not a quantity, as a misspelling of a word in kWhenTable.
    void check_word(const Exit& exit) {
        const std::string& text = exit.condition;
        if (!is_word(text) || plan.quantities.find(text)) return;
        std::vector<std::string> words;
        for (size_t i = 0; i < static_cast<size_t>(When::expression); ++i)
            words.emplace_back(kWhenTable[i].name);
        const std::string guess = nearest(text, words);
        std::vector<Choice> choices = choices_of(words);
        for (const Choice& quantity : choices_of(plan.quantities.names()))
            choices.push_back(quantity);
        error(exit.place, "when", fmt::format("'{}' is not a known condition", text),
              guess.empty() ? fmt::format("Use {}, or an expression.", fmt::join(words, ", "))
                            : fmt::format("Did you mean {}?", guess),
              std::move(choices));
    }

    void check_condition(const Exit& exit) {
        if (exit.has(WhenRow::region)) names.need(exit.region, exit.place, "region", diagnostics);
        if (exit.when == When::lifted) {
            bodies_.check_movable(exit.body, exit.place, "body");
        } else if (exit.has(WhenRow::body)) {
            names.need(exit.body, exit.place, "body", diagnostics);
        }
        if (exit.when == When::gripped && names.all<scene::Finger>().size() < 2)
            error(exit.place, "when", "a grip takes two fingers, but the scene has one",
                  "Use when: touched.");
        if (exit.has(WhenRow::any_finger)) check_who(exit);
        if (exit.has(WhenRow::key) && !is_key(exit.key)) {
            error(exit.place, "key", fmt::format("'{}' is not a valid key", exit.key),
                  "Write one letter or digit, e.g. key: y.");
        }
        if (exit.when == When::time && !exit.hold.computed() && exit.hold.value <= 0)
            error(exit.place, "after", "the duration is missing", "Add e.g. after_s: 2.");
        if (exit.when == When::trigger && exit.hold != 0)
            error(exit.place, "hold", "a trigger has no duration", "Leave it out.");
    }

    /// Checks the finger, hand or body to which the condition refers.
    void check_who(const Exit& exit) {
        if (!exit.what.empty()) {
            const int i = look_up(plan.quantities.things(), exit.what, exit.place, "what",
                                  "neither a body, a finger nor a hand", diagnostics);
            if (!exit.finger.empty())
                error(exit.place, "finger", "duplicates the key 'what'", "Leave it out.");
            if (i >= 0 && exit.shown && plan.quantities.thing(exit.what)->body >= 0)
                error(exit.place, "shown", "applies to fingers and hands, not to bodies",
                      "Leave it out.");
        }
        if (exit.finger.empty()) return;
        std::vector<std::string> known = names.all<scene::Finger>();
        for (const Hand& hand : plan.task.hands) known.push_back(hand.name);
        const int i = look_up(known, exit.finger, exit.place, "finger",
                              "neither a finger of the scene nor a hand of the task", diagnostics);
        if (i < 0 || exit.when != When::gripped) return;
        if (plan.quantities.thing(exit.finger)->fingers.count() < 2)
            error(exit.place, "finger",
                  fmt::format("a grip takes two fingers, but '{}' is one", exit.finger),
                  "Name a hand, or use when: touched.");
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
