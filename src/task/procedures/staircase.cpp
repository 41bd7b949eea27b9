#include "task/procedures/staircase.h"

#include <algorithm>
#include <cmath>

#include "base/diagnostics.h"

namespace dihaptic::task {
namespace {

bool positive(double x) {
    return std::isfinite(x) && x > 0;
}

void check(const StaircaseSettings& s) {
    Diagnostics problems;
    const auto require = [&](bool right, const char* key, const char* what, const char* remedy) {
        if (!right) problems.error({}, key, what, remedy);
    };
    require(s.down_after >= 1, "down_after", "is below 1",
            "give the number of consecutive answers, at least 1");
    require(!s.steps_up.empty() && std::all_of(s.steps_up.begin(), s.steps_up.end(), positive),
            "steps_up", "has no step, or a step that is not above 0",
            "give at least one step, all above 0");
    require(positive(s.down_over_up), "down_over_up", "is not above 0",
            "give the ratio of the step down to the step up, e.g. 0.5488 for 2-down");
    require(s.lowest < s.highest, "lowest", "is not below 'highest'",
            "make 'lowest' less than 'highest'");
    require(std::isfinite(s.start) && s.start >= s.lowest && s.start <= s.highest, "start",
            "is not between 'lowest' and 'highest'", "start at a level in that range");
    require(s.reversals >= 0 && s.trials >= 0 && s.reversals + s.trials > 0, "reversals",
            "and 'trials' set no end", "give at least one of them, above 0");
    require(
        s.skipped_reversals >= 0 && (s.reversals == 0 || s.skipped_reversals + 2 <= s.reversals),
        "skipped_reversals", "leaves fewer than two reversals",
        "skip fewer, or use more reversals");
    problems.throw_if_errors();
}

}  // namespace

double settling_probability(int down_after, double down_over_up) {
    return std::pow(1 + down_over_up, -1.0 / down_after);
}

double down_over_up_for(int down_after, double probability) {
    return std::pow(probability, -down_after) - 1;
}

Staircase::Staircase(StaircaseSettings settings)
    : settings_(std::move(settings)), level_(settings_.start) {
    check(settings_);
    // answers are processed during a tick, where allocation is forbidden
    reversals_.reserve(static_cast<size_t>(std::max(settings_.trials, settings_.reversals)));
}

void Staircase::answer(double level, bool yes) {
    ++trials_;
    if (!yes) {
        move(level, 1);
    } else if (++in_a_row_ == settings_.down_after) {
        move(level, -1);
    }
}

void Staircase::move(double level, int direction) {
    in_a_row_ = 0;
    if (direction_ == -direction) reversals_.push_back(level);
    direction_ = direction;
    const size_t step = std::min(reversals_.size(), settings_.steps_up.size() - 1);
    const double up = settings_.steps_up[step];
    level_ += direction > 0 ? up : -up * settings_.down_over_up;
    // rounded so that a recurring level is always the same number: 0.8 - 4 x 0.2 is not exactly 0
    level_ = std::round(level_ * 1e9) / 1e9;
    level_ = std::clamp(level_, settings_.lowest, settings_.highest);
}

bool Staircase::done() const {
    return (settings_.trials > 0 && trials_ >= settings_.trials) ||
           (settings_.reversals > 0 &&
            reversals_.size() >= static_cast<size_t>(settings_.reversals));
}

Estimate Staircase::estimate() const {
    const auto skipped = static_cast<size_t>(settings_.skipped_reversals);
    Estimate estimate;
    if (reversals_.size() < skipped + 2) return estimate;
    const size_t count = (reversals_.size() - skipped) / 2 * 2;
    double sum = 0;
    for (size_t i = reversals_.size() - count; i < reversals_.size(); ++i) sum += reversals_[i];
    estimate.threshold = sum / static_cast<double>(count);
    return estimate;
}

}  // namespace dihaptic::task
