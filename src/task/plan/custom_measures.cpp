#include "task/plan/custom_measures.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "base/unmeasured.h"
#include "task/plan/lookup.h"
#include "task/plan/plan_formulas.h"
#include "task/run/recorded.h"

namespace dihaptic::task {
namespace {

void check_name(const CustomMeasure& measure, const TaskPlan& plan, Diagnostics& diagnostics) {
    std::vector<Table::Column> columns = kTrialListColumns;
    for (const auto& more : {own_columns(plan.task), measure_columns()})
        columns.insert(columns.end(), more.begin(), more.end());
    const auto is_name = [&](const Table::Column& c) { return c.name == measure.name; };
    if (!is_word(measure.name)) {
        diagnostics.error(measure.place, "name",
                          fmt::format("'{}' cannot be the name of a column", measure.name),
                          "Use letters, digits and _, with the unit at the end, e.g. squeeze_N.");
    } else if (std::any_of(columns.begin(), columns.end(), is_name)) {
        diagnostics.error(measure.place, "name",
                          fmt::format("'{}' is the name of another column", measure.name),
                          "Use another name.");
    }
}

/// Returns the unit at the end of a column's name, e.g. "N/s" for rate_N_s, or "" if the name has
/// no unit.
std::string unit_of(const std::string& column) {
    const NameInUnit name = split_unit(column);
    if (name.quantity == Quantity::none) return "";
    std::string unit = column.substr(name.name.size() + 1);
    std::replace(unit.begin(), unit.end(), '_', '/');
    return unit;
}

}  // namespace

void plan_custom_measures(TaskPlan& plan, Diagnostics& diagnostics) {
    plan.measured = plan.quantities;
    const std::vector<CustomMeasure>& measures = plan.task.custom_measures;
    check_names(measures, "measures", diagnostics);
    for (const CustomMeasure& measure : measures) {
        check_name(measure, plan, diagnostics);
        TaskPlan::Measured out;
        out.take = measure.take;
        out.window = measure.window.value_or(0);
        out.states = states_of(measure);
        const Formula of = formula_of(measure.of, measure.name, "of", measure.place);
        if (auto when =
                compile_condition(measure.when, plan.measured, measure.place, "when", diagnostics))
            out.when = std::move(*when);
        if (auto compiled = compile_formula(of, plan, plan.measured, diagnostics)) {
            out.value = std::move(*compiled);
            plan.custom_measures.push_back(std::move(out));
        }
    }
}

std::vector<Table::Column> columns_of(const std::vector<CustomMeasure>& measures) {
    std::vector<Table::Column> out;
    for (const CustomMeasure& measure : measures) {
        out.push_back(
            {measure.name,
             fmt::format(
                 "{} of {}{}{}{}", enum_name(measure.take), measure.of,
                 measure.during.empty() ? std::string()
                                        : fmt::format(" in {}", fmt::join(measure.during, ", ")),
                 measure.when.empty() ? "" : fmt::format(" when {}", measure.when),
                 measure.window ? fmt::format(", moving mean over {:g} s", *measure.window) : ""),
             unit_of(measure.name)});
    }
    return out;
}

std::vector<Table::Column> columns_of(const std::vector<AskSpec>& questions) {
    std::vector<Table::Column> out;
    for (const AskSpec& ask : questions) out.push_back({ask.name, ask.question, unit_of(ask.name)});
    return out;
}

CustomMeasures::CustomMeasures(TaskPlan plan)
    : plan_([&] {
          plan.quantities = plan.measured;
          return std::move(plan);
      }()),
      numbers_(plan_) {
    for (const TaskPlan::Measured& measure : plan_.custom_measures)
        taken_.emplace_back(measure.take);
    windows_.resize(taken_.size());
}

void CustomMeasures::add(const frame::Frame& frame) {
    // perturbations have already ended in the tick that ends an attempt
    if (frame.task.outcome >= 0) return;
    const double now = seconds(frame.time);
    const bool begins = began_ < 0;
    if (begins) began_ = now;
    if (frame.phase != phase_) entered_ = now;
    phase_ = frame.phase;
    numbers_.follow(frame.trial, frame.task.attempt, frame.task.variables, frame.phase - 1);
    numbers_.set_answers(frame.task.variables);
    Quantities& quantities = numbers_.quantities();
    quantities.set_times(now - entered_, now - began_);
    handles_of(frame, handles_);
    quantities.update(frame, handles_);
    for (const int body : plan_.task.stays.indices) {
        const auto i = static_cast<size_t>(body);
        if (begins) quantities.set(quantities.start(i), frame.bodies[i].X_WB.p);
    }
    for (size_t i = 0; i < taken_.size(); ++i) {
        const TaskPlan::Measured& measure = plan_.custom_measures[i];
        if ((measure.states >> (frame.phase - 1) & 1u) == 0) {
            windows_[i].clear();
            continue;
        }
        const double value = measure.in_tick(numbers_.values());
        if (measure.window > 0) {
            add_to_window(i, now, value);
        } else {
            taken_[i].add(value);
        }
    }
}

/// Adds a value to the window and, if the window is full of measured values, passes their mean on
/// to the statistic.
void CustomMeasures::add_to_window(size_t i, double now, double value) {
    constexpr double kTolerance = 1e-6;  // allows for rounding errors in sums of ticks [s]
    std::deque<std::pair<double, double>>& window = windows_[i];
    const double step = window.empty() ? 0 : now - window.back().first;
    if (std::isnan(value)) return window.clear();
    window.emplace_back(now, value);
    // time of the last tick before the window
    const double from = now - plan_.custom_measures[i].window;
    while (window.front().first <= from + kTolerance) window.pop_front();
    if (window.front().first > from + step + kTolerance) return;
    // computed anew each time, because one huge value would permanently spoil a running sum
    double sum = 0;
    for (const auto& [time, one] : window) sum += one;
    taken_[i].add(sum / static_cast<double>(window.size()));
}

std::vector<double> CustomMeasures::end_attempt() {
    std::vector<double> out;
    for (size_t i = 0; i < taken_.size(); ++i) {
        const double si = plan_.custom_measures[i].value.formula.to_si;
        out.push_back(taken_[i].statistic() / si);
        taken_[i].clear();
        windows_[i].clear();
    }
    phase_ = 0;
    began_ = -1;
    return out;
}

}  // namespace dihaptic::task
