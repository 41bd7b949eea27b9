#include "task/procedures/quest_plus.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include "base/diagnostics.h"
#include "task/procedures/posterior.h"

namespace dihaptic::task {
namespace {

double plogp(double p) {
    return p > 0 ? p * std::log(p) : 0;
}

double binary_entropy(double p) {
    return -plogp(p) - plogp(1 - p);
}

void check(const QuestPlusSettings& s) {
    Diagnostics problems;
    const auto grid = [&](const char* key, const std::vector<double>& values, double low,
                          double high, const char* range) {
        const bool inside = std::all_of(values.begin(), values.end(), [&](double x) {
            return std::isfinite(x) && x >= low && x <= high;
        });
        const bool ascending = std::adjacent_find(values.begin(), values.end(),
                                                  std::greater_equal<>()) == values.end();
        if (values.empty() || !inside || !ascending)
            problems.error({}, key, "is not an ascending list of values", range);
    };
    const double most = std::numeric_limits<double>::max();
    const double least = std::numeric_limits<double>::min();
    const bool linear_weibull = s.sigmoid == model::Sigmoid::weibull;
    grid("levels", s.levels, -most, most, "list the levels that may be presented");
    grid("thresholds", s.thresholds, linear_weibull ? least : -most, most,
         linear_weibull ? "list possible thresholds, above 0" : "list possible thresholds");
    grid("shapes", s.shapes, least, most, "list possible shapes, above 0");
    grid("lapses", s.lapses, 0, 0.49, "list possible lapse rates, from 0 to 0.49");
    if (!(s.guess >= 0 && s.guess < 1))
        problems.error({}, "guess", "is not in [0, 1)",
                       "give the probability of a correct guess, e.g. 0.5 for two choices");
    else if (!s.guess_is_lapse && !s.lapses.empty() && s.guess + s.lapses.back() >= 1)
        problems.error({}, "lapses", "and 'guess' leave no range between them",
                       "guess + lapse must be below 1");
    if (s.trials < 1) problems.error({}, "trials", "is below 1", "give the number of trials");
    problems.throw_if_errors();
}

}  // namespace

QuestPlus::QuestPlus(QuestPlusSettings settings) : settings_(std::move(settings)) {
    check(settings_);
    const size_t n =
        settings_.thresholds.size() * settings_.shapes.size() * settings_.lapses.size();
    posterior_.assign(n, 1.0 / static_cast<double>(n));
    yes_.reserve(n * settings_.levels.size());
    for (const double x : settings_.levels)
        for (size_t i = 0; i < n; ++i) yes_.push_back(function(i).probability(x));
    entropy_.reserve(yes_.size());
    for (const double p : yes_) entropy_.push_back(binary_entropy(p));
    choose();
}

const std::vector<double>& QuestPlus::grid(Parameter parameter) const {
    return parameter == kThreshold ? settings_.thresholds
           : parameter == kShape   ? settings_.shapes
                                   : settings_.lapses;
}

size_t QuestPlus::index(Parameter parameter, size_t i) const {
    const size_t lapses = settings_.lapses.size();
    const size_t shapes = settings_.shapes.size();
    return parameter == kThreshold ? i / (lapses * shapes)
           : parameter == kShape   ? i / lapses % shapes
                                   : i % lapses;
}

model::Psychometric QuestPlus::function(size_t i) const {
    const double lapse = settings_.lapses[index(kLapse, i)];
    return {settings_.sigmoid, settings_.thresholds[index(kThreshold, i)],
            settings_.shapes[index(kShape, i)], settings_.guess_is_lapse ? lapse : settings_.guess,
            lapse};
}

double QuestPlus::information(size_t level) const {
    const size_t n = posterior_.size();
    const double* yes = &yes_[level * n];
    const double* entropy = &entropy_[level * n];
    double p = 0, known = 0;
    for (size_t i = 0; i < n; ++i) {
        p += posterior_[i] * yes[i];
        known += posterior_[i] * entropy[i];
    }
    return binary_entropy(p) - known;
}

double QuestPlus::expected_entropy(size_t i) const {
    double entropy = 0;
    for (const double w : posterior_) entropy -= plogp(w);
    return entropy - information(i);
}

void QuestPlus::choose() {
    double most = -std::numeric_limits<double>::infinity();
    for (size_t i = 0; i < settings_.levels.size(); ++i) {
        const double here = information(i);
        if (here > most) {
            most = here;
            level_ = settings_.levels[i];
        }
    }
}

void QuestPlus::answer(double level, bool yes) {
    ++trials_;
    const auto& levels = settings_.levels;
    const auto known =
        static_cast<size_t>(std::find(levels.begin(), levels.end(), level) - levels.begin());
    for (size_t i = 0; i < posterior_.size(); ++i) {
        const double p = known < levels.size() ? yes_[known * posterior_.size() + i]
                                               : function(i).probability(level);
        posterior_[i] *= likelihood(p, yes);
    }
    normalise(posterior_);
    choose();
}

std::vector<double> QuestPlus::marginal(Parameter parameter) const {
    std::vector<double> sums(grid(parameter).size());
    for (size_t i = 0; i < posterior_.size(); ++i) sums[index(parameter, i)] += posterior_[i];
    return sums;
}

Estimate QuestPlus::estimate() const {
    const auto& thresholds = settings_.thresholds;
    const auto probabilities = marginal(kThreshold);
    return {task::mean(thresholds, probabilities), quantile(thresholds, probabilities, 0.025),
            quantile(thresholds, probabilities, 0.975)};
}

model::Psychometric QuestPlus::mode() const {
    const auto most = std::max_element(posterior_.begin(), posterior_.end());
    return function(static_cast<size_t>(most - posterior_.begin()));
}

model::Psychometric QuestPlus::mean() const {
    model::Psychometric f = mode();
    f.threshold = task::mean(settings_.thresholds, marginal(kThreshold));
    f.shape = task::mean(settings_.shapes, marginal(kShape));
    f.lapse = task::mean(settings_.lapses, marginal(kLapse));
    if (settings_.guess_is_lapse) f.guess = f.lapse;
    return f;
}

}  // namespace dihaptic::task
