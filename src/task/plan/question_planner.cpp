#include "task/plan/question_planner.h"

#include <fmt/format.h>

#include <algorithm>

#include "task/plan/levels.h"

namespace dihaptic::task {
namespace {

class QuestionPlanner : Planning {
  public:
    QuestionPlanner(const Planning& given, SeenPlanner& seen) : Planning(given), seen_(seen) {}

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

  private:
    void error(const Place& place, const std::string& key, const std::string& what,
               const std::string& remedy) {
        diagnostics.error(place, key, what, remedy);
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

    SeenPlanner& seen_;
};

}  // namespace

TaskPlan::Questions plan_questions(const Planning& given, SeenPlanner& seen, const State& state) {
    TaskPlan::Questions out;
    QuestionPlanner planner(given, seen);
    planner.ask(state, out);
    planner.check_answered(state);
    return out;
}

}  // namespace dihaptic::task
