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

/// Searches for the most likely function. The variables are the threshold, the logarithm of the
/// spread (the spread is the shape or, if the shape is a slope, its reciprocal), and the lapse
/// rate. Weibull functions are searched in log10 of the level, where threshold and slope are almost
/// independent of each other.
class Search {
  public:
    enum : size_t { kThreshold, kSpread, kLapse, kVariables };

    Search(std::span<const LevelCount> counts, const PsychometricFitSettings& settings)
        : counts_(counts.begin(), counts.end()), settings_(settings) {
        if (linear_weibull())
            for (LevelCount& c : counts_) c.level = std::log10(c.level);
        const auto [low, high] =
            std::minmax_element(counts_.begin(), counts_.end(),
                                [](const auto& a, const auto& b) { return a.level < b.level; });
        low_ = low->level;
        span_ = high->level - low->level;
        ranges_ = {Variable{low_ - span_, low_ + 2 * span_},
                   Variable{std::log(span_ / 1000), std::log(span_ * 10)},
                   Variable{0, settings_.max_lapse}};
        free_ = {true, !settings_.shape, settings_.max_lapse > 0};
        for (double share = -0.5; share < 1.55; share += 0.1)
            coarse_places_.push_back(low_ + share * span_);
        // a step function fits equally well anywhere between two levels
        places_ = coarse_places_;
        std::vector<double> levels;
        for (const LevelCount& c : counts_) levels.push_back(c.level);
        std::sort(levels.begin(), levels.end());
        constexpr size_t kMost = 40;
        const size_t step = 1 + levels.size() / kMost;
        for (size_t i = step; i < levels.size(); i += step)
            places_.push_back((levels[i - 1] + levels[i]) / 2);
        for (const double spread : kSpreads) spreads_.push_back(std::log(spread * span_));
        if (settings_.shape)
            spreads_ = {std::log(slope() ? 1 / *settings_.shape : *settings_.shape)};
        for (const double share : kLapses) lapses_.push_back(share * settings_.max_lapse);
        if (!free_[kLapse]) lapses_ = {0};
    }

    std::vector<LevelCount>& counts() { return counts_; }

    /// Returns the lowest of the minima found by starting, for each spread, from the best point of
    /// a grid, since flat and steep functions have separate minima.
    Minimum run() const {
        constexpr double kFine = 1e-7;
        const Minimum least = least_of(starts(places_, spreads_, lapses_), free_);
        return descend(least.x, free_, kFine);
    }
    /// Searches faster, for a resample: starts from the two best points of a coarser grid, with a
    /// precision that is still much finer than the differences between resamples.
    Minimum run_quickly() const {
        return least_of(few(starts(coarse_places_, spreads_, {lapses_.data(), 1})), free_);
    }
    /// Returns the points at which the profile of one variable, with the other variables refitted,
    /// has risen by half of the 95 % quantile of chi-squared.
    Interval interval(size_t variable, const std::vector<double>& best) const {
        if (!free_[variable]) return {best[variable], best[variable]};
        return profile_interval([&](double v) { return profile(variable, v); }, best[variable],
                                ranges_[variable], cost(best) + kChiSquared95 / 2);
    }

    /// Returns the function for these variables, in the unit of the data.
    Psychometric function(std::span<const double> x) const {
        Psychometric f = searched(x);
        if (linear_weibull()) {
            f.sigmoid = Sigmoid::weibull;
            f.threshold = std::pow(10, f.threshold);
        }
        return f;
    }
    /// Returns the variables for which function() returns `f`.
    std::vector<double> variables(const Psychometric& f) const {
        return {linear_weibull() ? std::log10(f.threshold) : f.threshold,
                std::log(slope() ? 1 / f.shape : f.shape), f.lapse};
    }
    /// Whether the steepest, or the flattest, function fits as well as the best one.
    bool may_be_steep(const Minimum& best) const { return may_be(best, ranges_[kSpread].low); }
    bool may_be_flat(const Minimum& best) const { return may_be(best, ranges_[kSpread].high); }

  private:
    using Free = std::array<bool, kVariables>;

    bool may_be(const Minimum& best, double spread) const {
        std::vector<double> x = best.x;
        x[kSpread] = spread;
        return free_[kSpread] && cost(x) < best.value + 0.01;
    }

    /// Returns the best grid point for each spread, sorted from best to worst.
    std::vector<Minimum> starts(std::span<const double> places, std::span<const double> spreads,
                                std::span<const double> lapses) const {
        std::vector<Minimum> best;
        for (const double spread : spreads) {
            Minimum& here = best.emplace_back(Minimum{{}, std::numeric_limits<double>::max()});
            for (const double place : places) {
                for (const double lapse : lapses) {
                    std::vector<double> x = {place, spread, lapse};
                    const double value = cost(x);
                    if (value < here.value) here = {std::move(x), value};
                }
            }
        }
        std::stable_sort(best.begin(), best.end(), less);
        return best;
    }
    static std::vector<Minimum> few(std::vector<Minimum> starts) {
        constexpr size_t kFew = 2;
        starts.resize(std::min(kFew, starts.size()));
        return starts;
    }

    /// Minimises from x over those variables that are free.
    Minimum descend(std::vector<double> x, const Free& free, double tolerance) const {
        std::vector<Variable> ranges;
        std::vector<double> start;
        for (size_t i = 0; i < kVariables; ++i) {
            if (!free[i]) continue;
            ranges.push_back(ranges_[i]);
            start.push_back(x[i]);
        }
        const auto fill = [&](std::span<const double> values) {
            for (size_t i = 0, j = 0; i < kVariables; ++i)
                if (free[i]) x[i] = values[j++];
        };
        const Cost of_free = [&](std::span<const double> values) {
            fill(values);
            return cost(x);
        };
        const Minimum found = minimise(of_free, ranges, std::move(start), tolerance);
        fill(found.x);
        return {std::move(x), found.value};
    }
    Minimum least_of(std::vector<Minimum> starts, const Free& free) const {
        constexpr double kCoarse = 1e-4;
        for (Minimum& m : starts) m = descend(m.x, free, kCoarse);
        return *std::min_element(starts.begin(), starts.end(), less);
    }

    /// Returns the lowest cost with one variable held at v.
    double profile(size_t held, double v) const {
        const std::array at = {v};
        Free free = free_;
        free[held] = false;
        return least_of(few(held == kThreshold ? starts(at, spreads_, lapses_)
                            : held == kSpread  ? starts(places_, at, lapses_)
                                               : starts(coarse_places_, spreads_, at)),
                        free)
            .value;
    }

    static bool less(const Minimum& a, const Minimum& b) { return a.value < b.value; }
    bool linear_weibull() const { return settings_.sigmoid == Sigmoid::weibull; }
    /// Whether the shape is a slope, i.e. the reciprocal of the spread.
    bool slope() const { return linear_weibull() || settings_.sigmoid == Sigmoid::weibull_log10; }

    Psychometric searched(std::span<const double> x) const {
        const double spread = std::exp(x[kSpread]);
        const double lapse = x[kLapse];
        return {linear_weibull() ? Sigmoid::weibull_log10 : settings_.sigmoid, x[kThreshold],
                slope() ? 1 / spread : spread, settings_.guess_is_lapse ? lapse : settings_.guess,
                lapse};
    }

    double cost(std::span<const double> x) const {
        const Psychometric f = searched(x);
        double sum = 0;
        for (const LevelCount& c : counts_) {
            // answers that are impossible under a function get a large but finite cost
            const double p = std::clamp(f.probability(c.level), 1e-12, 1 - 1e-12);
            sum -= c.yes * std::log(p) + (c.trials - c.yes) * std::log1p(-p);
        }
        return sum;
    }

    static constexpr std::array kLapses = {0.4, 0.0, 1.0};
    static constexpr std::array kSpreads = {0.002, 0.01, 0.03, 0.08, 0.2, 0.4, 0.8, 2.0, 8.0};
    std::vector<LevelCount> counts_;
    PsychometricFitSettings settings_;
    double low_ = 0, span_ = 0;
    std::array<Variable, kVariables> ranges_;
    Free free_{};
    // the grid
    std::vector<double> places_, coarse_places_, spreads_, lapses_;
};

void check(std::span<const LevelCount> counts, const PsychometricFitSettings& settings) {
    for (const LevelCount& c : counts) {
        if (!std::isfinite(c.level) || c.yes < 0 || c.trials < 1 || c.yes > c.trials)
            throw Error("the counts of answers at a level are invalid",
                        "give finite levels, each with at least one trial");
        if (!model::takes(settings.sigmoid, c.level))
            throw Error(
                "a Weibull function is not defined at a level of 0 or below",
                "fit another sigmoid, or fit weibull_log10 to the logarithms of the levels");
    }
    if (std::all_of(counts.begin(), counts.end(),
                    [&](const auto& c) { return c.level == counts.front().level; }))
        throw Error("answers at fewer than two levels do not determine a psychometric function",
                    "measure at two levels or more");
    if (!(settings.max_lapse >= 0 && settings.max_lapse < 0.5 && settings.guess >= 0 &&
          settings.guess + settings.max_lapse < 1))
        throw Error("guess and lapse rates leave no range between them",
                    "give a max_lapse in [0, 0.5) and a guess rate of 0 or more, below 1 together");
    if (settings.shape && !(*settings.shape > 0))
        throw Error("a known shape must be above 0", "give the slope or spread of the sigmoid");
}

/// Negative log likelihood of the saturated model, in which the probability of "yes" at each level
/// is the observed proportion.
double saturated(std::span<const LevelCount> counts) {
    double sum = 0;
    for (const LevelCount& c : counts) {
        if (c.yes > 0) sum -= c.yes * std::log(static_cast<double>(c.yes) / c.trials);
        const int no = c.trials - c.yes;
        if (no > 0) sum -= no * std::log(static_cast<double>(no) / c.trials);
    }
    return sum;
}

/// The z value of the Mann-Whitney test of the levels at which the answer was "yes" against those
/// at which it was "no", corrected for ties; 0 if all answers are alike.
double rise(std::span<const LevelCount> counts) {
    double yes = 0, n = 0, ranks = 0, ties = 0;
    for (const LevelCount& c : counts) {
        const double m = c.trials;
        ranks += c.yes * (n + (m + 1) / 2);
        ties += m * m * m - m;
        yes += c.yes;
        n += m;
    }
    const double variance = yes * (n - yes) / 12 * (n + 1 - ties / (n * (n - 1)));
    return variance > 0 ? (ranks - yes * (n + 1) / 2) / std::sqrt(variance) : 0;
}

}  // namespace

std::string why_no_threshold(std::span<const LevelCount> counts, const PsychometricFit& fit) {
    constexpr double kSure = 1.96;
    if (rise(counts) < -kSure)
        return "a guess, not a measurement: 'yes' becomes less likely as the level rises. Are "
               "'yes' and 'no' exchanged?";
    return fit.flat ? "a guess, not a measurement: 'yes' is as likely at all levels" : "";
}

std::vector<LevelCount> count(std::span<const Answer> answers) {
    std::vector<Answer> sorted(answers.begin(), answers.end());
    std::sort(sorted.begin(), sorted.end(),
              [](const Answer& a, const Answer& b) { return a.level < b.level; });
    std::vector<LevelCount> counts;
    if (sorted.empty()) return counts;
    // sums of steps return to the same level only up to rounding
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
    const bool flat = search.may_be_flat(best);
    return {search.function(best.x), best.value, 2 * (best.value - saturated(counts)),
            flat || search.may_be_steep(best), flat};
}

PsychometricIntervals profile_intervals(std::span<const LevelCount> counts,
                                        const PsychometricFit& fit,
                                        const PsychometricFitSettings& settings) {
    check(counts, settings);
    const Search search(counts, settings);
    const std::vector<double> best = search.variables(fit.function);
    // evaluates the function with one variable at either end of its interval
    const auto ends = [&](size_t variable) {
        const Interval found = search.interval(variable, best);
        std::vector<double> x = best;
        x[variable] = found.low;
        const Psychometric low = search.function(x);
        x[variable] = found.high;
        return std::pair(low, search.function(x));
    };
    const auto [left, right] = ends(Search::kThreshold);
    const auto [one, other] = ends(Search::kSpread);
    const auto [sure, lapsing] = ends(Search::kLapse);
    return {{left.threshold, right.threshold},
            {std::min(one.shape, other.shape), std::max(one.shape, other.shape)},
            {sure.lapse, lapsing.lapse}};
}

double deviance_share(std::span<const LevelCount> counts, const PsychometricFit& fit,
                      const PsychometricFitSettings& settings, int resamples, uint64_t seed) {
    check(counts, settings);
    if (resamples < 1) throw Error("there are no resamples", "500 are usual");
    Random random(seed, "bootstrap");
    Search search(counts, settings);
    int worse = 0;
    for (int i = 0; i < resamples; ++i) {
        for (size_t j = 0; j < counts.size(); ++j) {
            const double p = fit.function.probability(counts[j].level);
            int& yes = search.counts()[j].yes = 0;
            for (int k = 0; k < counts[j].trials; ++k) yes += random.uniform(0, 1) < p ? 1 : 0;
        }
        if (2 * (search.run_quickly().value - saturated(search.counts())) >= fit.deviance) ++worse;
    }
    return (worse + 1.0) / (resamples + 1.0);
}

}  // namespace dihaptic::analysis
