#include "task/plan/exit_condition.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

namespace dihaptic::task {
namespace {

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

class ConditionPlanner : Planning {
  public:
    ConditionPlanner(const Planning& given, BodyPlanner& bodies)
        : Planning(given), bodies_(bodies) {}

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

  private:
    void error(const Place& place, const std::string& key, const std::string& what,
               const std::string& remedy, std::vector<Choice> choices = {}) {
        diagnostics.error(place, key, what, remedy, std::move(choices));
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

    BodyPlanner& bodies_;
};

}  // namespace

Expression plan_condition(const Planning& given, BodyPlanner& bodies, const Exit& exit) {
    return ConditionPlanner(given, bodies).condition(exit);
}

}  // namespace dihaptic::task
