#include "task/plan/plan_formulas.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>

#include "base/number.h"
#include "base/text_file.h"
#include "base/unmeasured.h"
#include "task/plan/factors.h"
#include "task/plan/levels.h"
#include "task/plan/lookup.h"

namespace dihaptic::task {
namespace {

bool is_identifier(std::string_view text) {
    return is_word(text) && std::isdigit(static_cast<unsigned char>(text.front())) == 0;
}

/// Defines the quantities that have names in a task, and reports invalid names.
class Definer {
  public:
    Definer(TaskPlan& plan, Diagnostics& diagnostics) : plan_(plan), diagnostics_(diagnostics) {}

    void define() {
        const Task& task = plan_.task;
        if (!task.rounds.empty()) define_round(task);
        for (const DrawSpec& draw : task.draws) define(draw);
        for (const Factor& factor : factors_of(task)) define(factor);
        for (const Variable& variable : task.variables)
            define(variable.name, variable.start, Kind::variable, variable.place, "name");
        define_levels(task);
        for (const AskSpec& ask : questions_of(task))
            define(ask.name, kUnmeasured, Kind::variable, ask.place, "name");
        if (plan_.start.size() > frame::TaskFrame::kMostVariables) {
            diagnostics_.error(task.place, "variables",
                               fmt::format("there are {}, including levels of procedures and "
                                           "answers, but at most {} are allowed",
                                           plan_.start.size(), frame::TaskFrame::kMostVariables),
                               "Leave some out.");
        }
    }

  private:
    /// Whether the name can be used in a formula, and as a column next to existing columns.
    bool check_name(const std::string& name, const Place& place, const char* key) {
        const std::string plain(split_unit(name).name);
        Diagnostics ignored;
        Quantities own;
        own.define(plain, {}, Kind::draw);
        Expression::compile(plain, own, place, key, ignored);
        const auto in_table = [&](const Table::Column& c) { return c.name == name; };
        const auto& columns = kTrialListColumns;
        std::string what;
        if (!is_identifier(plain) || ignored.has_errors()) {
            what = "cannot be used in a formula";
        } else if (plain == "outcome" || plan_.quantities.find(plain)) {
            what = fmt::format("is already the quantity {} in formulas", plain);
        } else if (std::any_of(columns.begin(), columns.end(), in_table)) {
            what = "is already a column of trial-list.csv";
        } else {
            return true;
        }
        diagnostics_.error(place, key, fmt::format("'{}' {}", name, what),
                           "Use another name, of letters, digits and _, e.g. wait_s.");
        return false;
    }

    Symbol number(const std::string& name, Kind kind) {
        const NameInUnit unit = split_unit(name);
        return plan_.quantities.define(std::string(unit.name), dimension(unit.quantity), kind);
    }

    std::vector<double> codes(const std::vector<std::string>& texts) {
        std::vector<double> out;
        for (const std::string& text : texts) out.push_back(plan_.quantities.text(text));
        return out;
    }

    /// Defines the quantity whose value is the name of the round.
    void define_round(const Task& task) {
        std::vector<std::string> names = names_of(task.rounds);
        const auto beside = [](const Block& block) { return block.once != Once::no; };
        if (std::any_of(task.blocks.begin(), task.blocks.end(), beside)) names.emplace_back();
        const Symbol symbol = plan_.quantities.define_text("round", names, Kind::factor);
        std::vector<double> levels = codes(names);
        plan_.symbols.factors.push_back({symbol.slot, levels, true});
    }

    void define(const DrawSpec& draw) {
        check(draw, diagnostics_);
        if (!check_name(draw.name, draw.place, "name")) return;
        const NameInUnit unit = split_unit(draw.name);
        if (are_texts(draw.values())) {
            const Symbol symbol =
                plan_.quantities.define_text(std::string(unit.name), draw.values(), Kind::draw);
            plan_.symbols.draws.push_back({symbol.slot, 1, codes(draw.values())});
        } else {
            const Symbol symbol = number(draw.name, Kind::draw);
            plan_.symbols.draws.push_back({symbol.slot, unit.si, {}});
        }
    }

    void define(const Factor& factor) {
        if (!check_name(factor.factor, factor.place, "factor") || !all_have(factor)) return;
        const NameInUnit unit = split_unit(factor.factor);
        const bool texts = are_texts(factor.levels);
        const Symbol symbol = texts ? plan_.quantities.define_text(std::string(unit.name),
                                                                   factor.levels, Kind::factor)
                                    : number(factor.factor, Kind::factor);
        std::vector<double> levels;
        const std::vector<Condition>& owners = owners_of(plan_.task, factor.factor);
        for (const Condition& owner : owners) {
            const std::string level = level_of(owner, factor.factor);
            levels.push_back(texts ? plan_.quantities.text(level)
                                   : unit.si * *finite_number(level));
        }
        const bool of_rounds = &owners == &plan_.task.rounds;
        if (of_rounds) levels.push_back(kUnmeasured);  // value outside the rounds
        plan_.symbols.factors.push_back({symbol.slot, levels, of_rounds});
    }

    bool all_have(const Factor& factor) {
        for (const Condition& condition : owners_of(plan_.task, factor.factor)) {
            if (!level_of(condition, factor.factor).empty()) continue;
            diagnostics_.error(
                condition.place, "factors",
                fmt::format("'{}' has no level of {}", condition.name, factor.factor),
                fmt::format("Add e.g. factors: {{ {}: {} }}.", factor.factor,
                            factor.levels.front()));
            return false;
        }
        return true;
    }

    /// Defines a number that changes during the session. `start` is in the unit of the number's
    /// name.
    void define(const std::string& name, double start, Kind kind, const Place& place,
                const char* key) {
        const NameInUnit unit = split_unit(name);
        plan_.start.push_back({start * unit.si});
        if (!check_name(name, place, key)) {
            plan_.symbols.variables.push_back({});
            return;
        }
        const Symbol symbol = number(name, kind);
        const Symbol between = plan_.between.define(std::string(unit.name), symbol.dimension, kind);
        plan_.symbols.variables.push_back({symbol.slot, between.slot});
    }

    void define_levels(const Task& task) {
        const std::vector<LevelName> levels = levels_of(task);
        for (const LevelName& level : levels) {
            const double si = split_unit(level.name).si;
            TaskPlan::Level& out = plan_.levels.emplace_back();
            out.variable = plan_.start.size();
            out.standard = level.standard * si;
            out.si = si;
            for (const double value : level.values) out.values.push_back(value * si);
            define(level.name, level.standard, Kind::level, level.place, "level");
        }
        for (const ProcedureSpec& procedure : task.procedures) {
            const auto same = [&](const LevelName& l) { return l.name == procedure.level; };
            const auto found = std::find_if(levels.begin(), levels.end(), same);
            plan_.level_of_procedure.push_back(
                found == levels.end() ? -1 : static_cast<int>(found - levels.begin()));
        }
    }

    TaskPlan& plan_;
    Diagnostics& diagnostics_;
};

/// Whether the text names an angle. If it does, its value is in radians; otherwise, its value is in
/// the unit of the key.
bool names_angle(const TaskPlan& plan, std::string_view text) {
    const auto is_angle = [&](std::string_view name) {
        const auto named = [&](std::string_view key) {
            const NameInUnit unit = split_unit(key);
            return unit.name == name && unit.quantity == Quantity::angle;
        };
        const Task& task = plan.task;
        const auto any = [&](const auto& list) {
            return std::any_of(list.begin(), list.end(),
                               [&](const auto& item) { return named(item.name); });
        };
        const std::vector<Factor> factors = factors_of(task);
        // atan2() and joint angles are in radians, even if the text contains no unit
        return name == "deg" || name == "rad" || name == "atan2" || name == "angle" ||
               any(task.draws) || any(task.variables) || any(task.custom_measures) ||
               std::any_of(factors.begin(), factors.end(),
                           [&](const Factor& f) { return named(f.factor); }) ||
               std::any_of(task.procedures.begin(), task.procedures.end(),
                           [&](const ProcedureSpec& p) { return named(p.level); });
    };
    size_t begin = 0;
    for (size_t i = 0; i <= text.size(); ++i) {
        if (i < text.size() && is_word(text.substr(i, 1))) continue;
        if (i > begin && is_angle(text.substr(begin, i - begin))) return true;
        begin = i + 1;
    }
    return false;
}

void formula_error(const Formula& formula, const std::string& what, const std::string& remedy,
                   Diagnostics& diagnostics) {
    diagnostics.error(formula.place, formula.key, fmt::format("{}: '{}'", what, formula.text),
                      remedy);
}

void compile_all(TaskPlan& plan, Diagnostics& diagnostics) {
    // a failing formula is replaced with a number, so that the failure is reported only once
    each_formula(plan.task, [&](Formula& formula) {
        if (!formula.computed() || finite_number(formula.text)) return;
        auto compiled = compile_formula(formula, plan, plan.quantities, diagnostics);
        if (compiled && compiled->expression.follows_tick()) {
            formula_error(
                formula,
                "depends on a quantity that changes within a trial, but is evaluated when a trial "
                "begins",
                "Use draws, factors, variables and regions; or use a condition under 'when'.",
                diagnostics);
            return;
        }
        if (!compiled) return;
        formula.index = static_cast<int>(plan.formulas.size());
        compiled->formula.index = formula.index;
        plan.formulas.push_back(std::move(*compiled));
    });
    for (State& state : plan.task.states) {
        each_formula(state, [&](const Formula& formula) {
            if (formula.index >= 0) plan.in_states.push_back(formula.index);
        });
    }
}

}  // namespace

Formula formula_of(const std::string& text, const std::string& name, const char* key,
                   const Place& place) {
    const NameInUnit unit = split_unit(name);
    Formula out;
    out.text = text;
    out.to_si = unit.si;
    out.key = key;
    out.place = place;
    out.field = Field::of(unit.quantity);
    return out;
}

std::optional<CompiledFormula> compile_formula(const Formula& formula, const TaskPlan& plan,
                                               Quantities& quantities, Diagnostics& diagnostics) {
    CompiledFormula out;
    Diagnostics found;
    out.expression =
        Expression::compile(formula.text, quantities, formula.place, formula.key, found);
    out.formula = formula;
    for (Problem problem : found.problems()) {
        if (problem.severity == Severity::error)
            problem.what = "must be a number or a formula: " + problem.what;
        diagnostics.add({problem});
    }
    if (found.has_errors()) return {};
    const Quantity wanted = formula.field.quantity;
    const Dimension given = out.expression.dimension();
    if (out.expression.type() != Expression::Type::number) {
        formula_error(formula, "must be a number, or a formula with a number as its result",
                      "Convert a condition to a number with 'if', e.g. 10 if side > 0 else 20.",
                      diagnostics);
    } else if (given == Dimension{}) {
        const bool angle = wanted == Quantity::angle && names_angle(plan, formula.text);
        out.scale = angle ? 1 : formula.to_si;
        return out;
    } else if (given == dimension(wanted)) {
        return out;
    } else {
        formula_error(formula,
                      fmt::format("is in {}, but must be a {}", si_symbol(given), name(wanted)),
                      "Divide by a unit, e.g. wait / 1 s, or use another quantity.", diagnostics);
    }
    return {};
}

std::optional<Expression> compile_condition(const std::string& text, Quantities& quantities,
                                            const Place& place, const char* key,
                                            Diagnostics& diagnostics) {
    if (text.empty()) return {};
    Diagnostics found;
    Expression out = Expression::compile(text, quantities, place, key, found);
    diagnostics.add(found.problems());
    if (found.has_errors()) return {};
    if (out.type() != Expression::Type::truth) {
        diagnostics.error(place, key, fmt::format("'{}' is not a condition", text),
                          "Write a comparison, e.g. score > 10.");
    }
    return out;
}

void plan_formulas(TaskPlan& plan, Diagnostics& diagnostics) {
    Definer(plan, diagnostics).define();
    if (!diagnostics.has_errors()) compile_all(plan, diagnostics);
}

namespace {

/// Prefix of a custom measure's name in rules; the name is used there without its unit.
constexpr const char* kMeasurePrefix = "measure.";

std::vector<int> define_measures(TaskPlan& plan) {
    std::vector<int> slots;
    for (const CustomMeasure& measure : plan.task.custom_measures) {
        const NameInUnit name = split_unit(measure.name);
        const Symbol symbol = plan.quantities.define(kMeasurePrefix + std::string(name.name),
                                                     dimension(name.quantity), Kind::figure);
        slots.push_back(symbol.slot);
    }
    return slots;
}

/// Checks that no two measures have the name used in a rule, apart from their units.
void check_alone(const CustomMeasure& measure, const Task& task, Diagnostics& diagnostics) {
    const std::string_view name = split_unit(measure.name).name;
    for (const CustomMeasure& other : task.custom_measures) {
        if (other.name == measure.name || split_unit(other.name).name != name) continue;
        diagnostics.error(measure.place, "name",
                          fmt::format("'{}' and '{}' are both {}{} in after_trial", other.name,
                                      measure.name, kMeasurePrefix, name),
                          "Give them names that differ by more than their unit.");
    }
}

/// Plans the look-backs of rules, and the custom measures named in rules.
void plan_what_rules_need(TaskPlan& plan, const std::vector<int>& slots, Diagnostics& diagnostics) {
    std::vector<const Expression*> rules;
    const auto add = [&](const Expression& rule) {
        rules.push_back(&rule);
        const std::vector<LookBack>& own = rule.look_backs();
        plan.look_backs.insert(plan.look_backs.end(), own.begin(), own.end());
    };
    for (TaskPlan::Change& change : plan.changes) {
        if (change.when) add(*change.when);
        add(change.to.expression);
        change.look_backs = plan.look_backs.size();
    }
    for (const LookBack& look_back : plan.look_backs) rules.push_back(&look_back.of);
    for (size_t i = 0; i < slots.size(); ++i) {
        const auto names = [&](const Expression* rule) { return rule->names(slots[i]); };
        if (std::none_of(rules.begin(), rules.end(), names)) continue;
        const CustomMeasure& measure = plan.task.custom_measures[i];
        check_alone(measure, plan.task, diagnostics);
        if (measure.take == Take::median || measure.window) {
            diagnostics.error(measure.place, measure.window ? "window" : "take",
                              "gives the measure its value only after the session, but after_trial "
                              "uses the measure",
                              "Take another statistic, or leave the measure out of the rules.");
            continue;
        }
        const Formula of = formula_of(measure.of, measure.name, "of", measure.place);
        Diagnostics told;  // discarded, because plan_custom_measures() reports these problems
        auto compiled = compile_formula(of, plan, plan.quantities, told);
        if (!compiled) continue;
        TaskPlan::RuleMeasure added{{std::move(*compiled), {}, measure.take, 0, states_of(measure)},
                                    slots[i]};
        if (auto when =
                compile_condition(measure.when, plan.quantities, measure.place, "when", told))
            added.measured.when = std::move(*when);
        plan.rule_measures.push_back(std::move(added));
    }
}

}  // namespace

void plan_rules(TaskPlan& plan, Diagnostics& diagnostics) {
    const std::vector<int> measures = define_measures(plan);
    plan.quantities.let_look_back(true);
    std::vector<std::string> outcomes;
    for (const TaskPlan::Outcome& outcome : plan.outcomes) outcomes.push_back(outcome.name);
    plan.symbols.outcome = plan.quantities.define_text("outcome", outcomes, Kind::figure).slot;
    for (const std::string& outcome : outcomes)
        plan.symbols.outcomes.push_back(plan.quantities.text(outcome));
    for (const Rule& rule : plan.task.after_trial) {
        TaskPlan::Change change;
        change.when =
            compile_condition(rule.when, plan.quantities, rule.place, "when", diagnostics);
        if (rule.set.index < 0) continue;
        change.variable = static_cast<size_t>(rule.set.index);
        const Formula to = formula_of(rule.to, rule.set, "to", rule.place);
        if (auto compiled = compile_formula(to, plan, plan.quantities, diagnostics)) {
            change.to = std::move(*compiled);
            plan.changes.push_back(std::move(change));
        }
    }
    plan.quantities.let_look_back(false);
    plan_what_rules_need(plan, measures, diagnostics);
    for (const Block& block : plan.task.blocks)
        plan.until.push_back(
            compile_condition(block.until, plan.between, block.place, "until", diagnostics));
}

}  // namespace dihaptic::task
