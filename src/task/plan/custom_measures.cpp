#include "task/plan/custom_measures.h"

#include <fmt/format.h>

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

}  // namespace

void plan_custom_measures(TaskPlan& plan, Diagnostics& diagnostics) {
    plan.measured = plan.quantities;
    const std::vector<CustomMeasure>& measures = plan.task.custom_measures;
    check_names(measures, "measures", diagnostics);
    for (const CustomMeasure& measure : measures) {
        check_name(measure, plan, diagnostics);
        TaskPlan::Measured out;
        out.take = measure.take;
        for (const int state : measure.during.indices) out.states |= uint64_t{1} << state;
        if (measure.during.empty()) out.states = ~uint64_t{0};
        const Formula of = formula_of(measure.of, measure.name, "of", measure.place);
        if (auto compiled = compile_formula(of, plan, plan.measured, diagnostics)) {
            out.value = std::move(*compiled);
            plan.custom_measures.push_back(std::move(out));
        }
    }
}

std::vector<Table::Column> columns_of(const std::vector<CustomMeasure>& measures) {
    std::vector<Table::Column> out;
    for (const CustomMeasure& measure : measures) {
        const NameInUnit name = split_unit(measure.name);
        std::string unit;
        if (name.quantity != Quantity::none) unit = measure.name.substr(name.name.size() + 1);
        std::replace(unit.begin(), unit.end(), '_', '/');
        out.push_back(
            {measure.name, fmt::format("{} of {}", enum_name(measure.take), measure.of), unit});
    }
    return out;
}

CustomMeasures::CustomMeasures(TaskPlan plan)
    : plan_([&] {
          plan.quantities = plan.measured;
          return std::move(plan);
      }()),
      numbers_(plan_),
      taken_(plan_.custom_measures.size()) {}

void CustomMeasures::add(const frame::Frame& frame) {
    const double now = seconds(frame.time);
    if (began_ < 0) began_ = now;
    if (frame.phase != phase_) entered_ = now;
    phase_ = frame.phase;
    numbers_.follow(frame.trial, frame.task.attempt, frame.task.variables, frame.phase - 1);
    Quantities& quantities = numbers_.quantities();
    quantities.set(Quantities::kTimeInState, now - entered_);
    quantities.set(Quantities::kTimeInTrial, now - began_);
    handles_of(frame, handles_);
    quantities.update(frame, handles_);
    for (size_t i = 0; i < taken_.size(); ++i) {
        const TaskPlan::Measured& measure = plan_.custom_measures[i];
        if ((measure.states >> (frame.phase - 1) & 1u) == 0) continue;
        const double value = measure.value.value(numbers_.values());
        Taken& taken = taken_[i];
        const bool first = taken.ticks++ == 0;
        switch (measure.take) {
            case Take::first:
                if (first) taken.value = value;
                break;
            case Take::last:
                taken.value = value;
                break;
            case Take::min:
                taken.value = first ? value : std::fmin(taken.value, value);
                break;
            case Take::max:
                taken.value = first ? value : std::fmax(taken.value, value);
                break;
            case Take::mean:
                taken.value += (value - taken.value) / static_cast<double>(taken.ticks);
                break;
        }
    }
}

std::vector<double> CustomMeasures::end_attempt() {
    std::vector<double> out;
    for (size_t i = 0; i < taken_.size(); ++i) {
        const double si = plan_.custom_measures[i].value.formula.to_si;
        out.push_back(taken_[i].ticks > 0 ? taken_[i].value / si : kUnmeasured);
        taken_[i] = {};
    }
    phase_ = 0;
    began_ = -1;
    return out;
}

}  // namespace dihaptic::task
