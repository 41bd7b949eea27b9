#include "analysis/fits/psychometric_fit.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "base/diagnostics.h"
#include "base/random.h"

namespace dihaptic::analysis {
namespace {

using model::Psychometric;
using model::Sigmoid;

/// The search for the most likely function. Its variables are the threshold, ln of the spread (the
/// shape, or one over it if the shape is a slope), and the lapse rate. Weibull functions are
/// searched in log10 of the level, where threshold and slope hardly depend on each other.
class Search {
  public:
    Search(std::span<const LevelCount> counts, const PsychometricFitSettings& settings)
        : counts_(counts.begin(), counts.end()), settings_(settings) {
        if (linear_weibull())
            for (LevelCount& c : counts_) c.level = std::log10(c.level);
        const auto [low, high] =
            std::minmax_element(counts_.begin(), counts_.end(),
                                [](const auto& a, const auto& b) { return a.level < b.level; });
        low_ = low->level;
        span_ = high->level - low->level;
        variables_ = {{low_ - span_, low_ + 2 * span_},
                      {std::log(span_ / 1000), std::log(span_ * 10)}};
        if (settings_.max_lapse > 0) variables_.push_back({0, settings_.max_lapse});
        for (double share = -0.5; share < 1.55; share += 0.1)
            coarse_places_.push_back(low_ + share * span_);
        // a step function fits equally well at any place between two levels
        places_ = coarse_places_;
        std::vector<double> levels;
        for (const LevelCount& c : counts_) levels.push_back(c.level);
        std::sort(levels.begin(), levels.end());
        constexpr size_t kMost = 40;
        const size_t step = 1 + levels.size() / kMost;
        for (size_t i = step; i < levels.size(); i += step)
            places_.push_back((levels[i - 1] + levels[i]) / 2);
    }

    std::vector<LevelCount>& counts() { return counts_; }

    /// The least of the minima found from the best point of a grid at each spread, since flat and
    /// steep functions have minima of their own.
    Minimum run() const { return run(Effort::full); }
    /// For a resample: searches from the two best points of a coarser grid, with a precision far
    /// finer than the differences between resamples.
    Minimum run_quickly() const { return run(Effort::quick); }

    /// The function in the unit of the data.
    Psychometric function(std::span<const double> x) const {
        Psychometric f = searched(x);
        if (linear_weibull()) {
            f.sigmoid = Sigmoid::weibull;
            f.threshold = std::pow(10, f.threshold);
        }
        return f;
    }
    /// Whether a function with its spread at an end of the range fits as well as the best.
    bool shape_unknown(const Minimum& best) const {
        std::vector<double> x = best.x;
        for (const double end : {variables_[1].low, variables_[1].high}) {
            x[1] = end;
            if (cost(x) < best.value + 0.01) return true;
        }
        return false;
    }

  private:
    enum class Effort { full, quick };

    Minimum run(Effort effort) const {
        constexpr double kFine = 1e-7;
        constexpr size_t kQuickStarts = 2;
        const bool fine = effort == Effort::full;
        std::vector<Minimum> best;
        for (const double spread : kSpreads) {
            Minimum& here = best.emplace_back(Minimum{{}, std::numeric_limits<double>::max()});
            for (const double place : fine ? places_ : coarse_places_) {
                for (const double lapse : fine ? kLapses : kLapses.first(1)) {
                    std::vector<double> x = {place, std::log(spread * span_)};
                    if (variables_.size() > 2) x.push_back(lapse * settings_.max_lapse);
                    const double value = cost(x);
                    if (value < here.value) here = {std::move(x), value};
                    if (variables_.size() == 2) break;
                }
            }
        }
        const auto less = [](const Minimum& a, const Minimum& b) { return a.value < b.value; };
        std::stable_sort(best.begin(), best.end(), less);
        if (!fine) best.resize(std::min(kQuickStarts, best.size()));
        const Cost all = [this](std::span<const double> x) { return cost(x); };
        for (Minimum& m : best) m = minimise(all, variables_, m.x, kCoarse);
        const Minimum& least = *std::min_element(best.begin(), best.end(), less);
        return fine ? minimise(all, variables_, least.x, kFine) : least;
    }

    bool linear_weibull() const { return settings_.sigmoid == Sigmoid::weibull; }

    Psychometric searched(std::span<const double> x) const {
        const double spread = std::exp(x[1]);
        const double lapse = x.size() > 2 ? x[2] : 0;
        const bool slope = linear_weibull() || settings_.sigmoid == Sigmoid::weibull_log10;
        return {linear_weibull() ? Sigmoid::weibull_log10 : settings_.sigmoid, x[0],
                slope ? 1 / spread : spread, settings_.guess_is_lapse ? lapse : settings_.guess,
                lapse};
    }

    double cost(std::span<const double> x) const {
        const Psychometric f = searched(x);
        double sum = 0;
        for (const LevelCount& c : counts_) {
            // answers that are impossible under a function cost much, but not infinitely much
            const double p = std::clamp(f.probability(c.level), 1e-12, 1 - 1e-12);
            sum -= c.yes * std::log(p) + (c.trials - c.yes) * std::log1p(-p);
        }
        return sum;
    }

    std::vector<LevelCount> counts_;
    PsychometricFitSettings settings_;
    static constexpr double kCoarse = 1e-4;
    static constexpr double kLapseShares[] = {0.4, 0.0, 1.0};
    static constexpr std::span<const double> kLapses{kLapseShares};
    static constexpr std::array kSpreads = {0.002, 0.01, 0.03, 0.08, 0.2, 0.4, 0.8, 2.0, 8.0};
    double low_ = 0, span_ = 0;
    std::vector<double> places_, coarse_places_;  // thresholds of the grid
    std::vector<Variable> variables_;
};

void check(std::span<const LevelCount> counts, const PsychometricFitSettings& settings) {
    for (const LevelCount& c : counts) {
        if (!std::isfinite(c.level) || c.yes < 0 || c.trials < 1 || c.yes > c.trials)
            throw Error("the answers at a level cannot be counted",
                        "give finite levels, each with a trial or more");
        if (!model::takes(settings.sigmoid, c.level))
            throw Error("a Weibull function has no level of 0 or below",
                        "fit another sigmoid, or weibull_log10 to logarithms");
    }
    if (std::all_of(counts.begin(), counts.end(),
                    [&](const auto& c) { return c.level == counts.front().level; }))
        throw Error("answers at fewer than two levels tell of no psychometric function",
                    "measure at two levels or more");
    if (!(settings.max_lapse >= 0 && settings.max_lapse < 0.5 && settings.guess >= 0 &&
          settings.guess + settings.max_lapse < 1))
        throw Error("guess and lapse rates leave nothing between them",
                    "give a guess rate and a max_lapse in [0, 0.5), below 1 together");
}

/// Negative log likelihood when each level has the share of "yes" that was counted.
double saturated(std::span<const LevelCount> counts) {
    double sum = 0;
    for (const LevelCount& c : counts) {
        if (c.yes > 0) sum -= c.yes * std::log(static_cast<double>(c.yes) / c.trials);
        const int no = c.trials - c.yes;
        if (no > 0) sum -= no * std::log(static_cast<double>(no) / c.trials);
    }
    return sum;
}

/// Interval of the middle 95 % of the values, between ranks 0.025 (n + 1) and 0.975 (n + 1).
Interval middle_95(std::vector<double> values) {
    std::sort(values.begin(), values.end());
    const auto last = static_cast<double>(values.size() - 1);
    const auto at = [&](double share) {
        const double place = std::clamp(share * (last + 2) - 1, 0.0, last);
        const auto i = static_cast<size_t>(place);
        const double part = place - static_cast<double>(i);
        return values[i] + part * (values[std::min(i + 1, values.size() - 1)] - values[i]);
    };
    return {at(0.025), at(0.975)};
}

}  // namespace

std::vector<LevelCount> count(std::span<const Answer> answers) {
    std::vector<Answer> sorted(answers.begin(), answers.end());
    std::sort(sorted.begin(), sorted.end(),
              [](const Answer& a, const Answer& b) { return a.level < b.level; });
    std::vector<LevelCount> counts;
    if (sorted.empty()) return counts;
    // sums of steps come back to a level only up to rounding
    const double same = 1e-9 * (sorted.back().level - sorted.front().level);
    for (const Answer& answer : sorted) {
        if (counts.empty() || answer.level > counts.back().level + same)
            counts.push_back({answer.level, 0, 0});
        counts.back().yes += answer.yes ? 1 : 0;
        ++counts.back().trials;
    }
    return counts;
}

PsychometricFit fit_psychometric(std::span<const LevelCount> counts,
                                 const PsychometricFitSettings& settings) {
    check(counts, settings);
    const Search search(counts, settings);
    const Minimum best = search.run();
    return {search.function(best.x), best.value, 2 * (best.value - saturated(counts)),
            search.shape_unknown(best)};
}

PsychometricIntervals bootstrap(std::span<const LevelCount> counts, const PsychometricFit& fit,
                                const PsychometricFitSettings& settings, int resamples,
                                uint64_t seed) {
    check(counts, settings);
    if (resamples < 1) throw Error("there are no resamples", "1000 are usual for an interval");
    Random random(seed, "bootstrap");
    Search search(counts, settings);
    std::vector<double> thresholds, shapes, lapses;
    int worse = 0;
    for (int i = 0; i < resamples; ++i) {
        for (size_t j = 0; j < counts.size(); ++j) {
            const double p = fit.function.probability(counts[j].level);
            int& yes = search.counts()[j].yes = 0;
            for (int k = 0; k < counts[j].trials; ++k) yes += random.uniform(0, 1) < p ? 1 : 0;
        }
        const Minimum best = search.run_quickly();
        const Psychometric f = search.function(best.x);
        thresholds.push_back(f.threshold);
        shapes.push_back(f.shape);
        lapses.push_back(f.lapse);
        if (2 * (best.value - saturated(search.counts())) >= fit.deviance) ++worse;
    }
    return {middle_95(std::move(thresholds)), middle_95(std::move(shapes)),
            middle_95(std::move(lapses)), (worse + 1.0) / (resamples + 1.0)};
}

}  // namespace dihaptic::analysis
