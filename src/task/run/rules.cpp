#include "task/run/rules.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "task/run/recorded.h"

namespace dihaptic::task {
namespace {

/// Returns the statistic of the values at the ends of the last trials. `sorted` is memory for
/// sorting these values.
double statistic_of(LookBack::Statistic statistic, const std::vector<double>& x,
                    std::vector<double>& sorted) noexcept {
    if (x.empty()) return kUnmeasured;
    const auto count = static_cast<double>(x.size());
    const double mean = std::accumulate(x.begin(), x.end(), 0.0) / count;
    double squares = 0;
    for (const double value : x) squares += (value - mean) * (value - mean);
    switch (statistic) {
        case LookBack::Statistic::mean:
            return mean;
        case LookBack::Statistic::sd:
            return x.size() > 1 ? std::sqrt(squares / (count - 1)) : kUnmeasured;
        case LookBack::Statistic::best:
            return *std::max_element(x.begin(), x.end());
        case LookBack::Statistic::median:
            sorted.assign(x.begin(), x.end());
            return median_of(sorted);
    }
    return kUnmeasured;
}

}  // namespace

Rules::Rules(const TaskPlan& plan, size_t quantities) : plan_(plan), in_frame_(quantities) {
    for (const TaskPlan::RuleMeasure& measure : plan.rule_measures)
        taken_.emplace_back(measure.measured.take);
    frame_handles_.reserve(plan.finger_radius.size());
    for (const LookBack& look_back : plan.look_backs) {
        Past& past = past_.emplace_back();
        past.values.reserve(look_back.count);
        past.sorted.reserve(look_back.count);
    }
}

void Rules::take_measures(const frame::Frame& last, int state, Quantities& quantities) noexcept {
    if (state < 0 || taken_.empty()) return;
    handles_of(last, frame_handles_);
    quantities.read_frame(last, frame_handles_, in_frame_);
    for (size_t i = 0; i < taken_.size(); ++i) {
        const TaskPlan::Measured& measured = plan_.rule_measures[i].measured;
        if ((measured.states >> state & 1u) != 0) taken_[i].add(measured.in_tick(in_frame_));
    }
}

/// Sets a range of the statistics over earlier trials that rules use. `counts` tells whether these
/// statistics include the attempt that has just ended.
void Rules::look_back(size_t from, size_t to, bool counts, Quantities& quantities) noexcept {
    for (size_t i = from; i < to; ++i) {
        const LookBack& what = plan_.look_backs[i];
        Past& past = past_[i];
        const double value = what.of(quantities.values());
        if (counts && std::isfinite(value)) {
            past.best = std::fmax(past.best, value);
            if (past.values.size() < what.count) {
                past.values.push_back(value);
            } else if (what.count > 0) {
                past.values[past.next] = value;
                past.next = (past.next + 1) % what.count;
            }
        }
        quantities.set(what.slot, what.count == 0
                                      ? past.best
                                      : statistic_of(what.statistic, past.values, past.sorted));
    }
}

void Rules::follow(int outcome, bool counts, TrialNumbers& numbers,
                   std::vector<frame::VariableFrame>& variables) noexcept {
    Quantities& quantities = numbers.quantities();
    quantities.set(plan_.symbols.outcome, plan_.symbols.outcomes[static_cast<size_t>(outcome)]);
    for (size_t i = 0; i < taken_.size(); ++i) {
        quantities.set(plan_.rule_measures[i].slot, taken_[i].statistic());
        taken_[i].clear();
    }
    size_t looked = 0;
    for (const TaskPlan::Change& change : plan_.changes) {
        // the statistics in a rule include the values that earlier rules have set in this trial
        look_back(std::exchange(looked, change.look_backs), change.look_backs, counts, quantities);
        if (change.when && (*change.when)(quantities.values()) == 0) continue;
        const double value = change.to.value(quantities.values());
        if (!std::isfinite(value)) continue;
        variables[change.variable].value = value;
        numbers.set(variables);
    }
}

}  // namespace dihaptic::task
