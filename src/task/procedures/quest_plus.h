// QUEST+ (Watson 2017) keeps a posterior over threshold, shape and lapse rate of a psychometric
// function (model/psychometric.h) on a grid. Each trial is at the level after which the entropy of
// the posterior is expected to be least,
//
//     E[H | x] = H - I(x),    I(x) = h(sum_i w_i p_i(x)) - sum_i w_i h(p_i(x))
//
// where w is the posterior, p_i is the probability of "yes" for the parameters i, H = -sum w ln w,
// and h(p) = -p ln p - (1 - p) ln(1 - p).
#pragma once

#include <cstddef>
#include <vector>

#include "model/psychometric.h"
#include "task/procedures/estimate.h"

namespace dihaptic::task {

struct QuestPlusSettings {
    model::Sigmoid sigmoid = model::Sigmoid::weibull_log10;
    std::vector<double> levels;      ///< levels that may be presented
    std::vector<double> thresholds;  ///< grid of thresholds, ascending like all grids
    /// Grid of shapes, e.g. {2, 3, 4, 5}, or a single value if the shape is known.
    std::vector<double> shapes;
    std::vector<double> lapses = {0.02};
    double guess = 0.5;
    /// Whether the lapse rate is used as the guess rate instead. This is for questions such as
    /// "more or less?" or "left or right?", for which the function goes from 0 to 1 apart from
    /// lapses.
    bool guess_is_lapse = false;
    int trials = 40;  ///< number of trials after which the procedure ends
};

class QuestPlus {
  public:
    /// Starts with a uniform prior on the grid. Throws Error if a setting is out of range.
    explicit QuestPlus(QuestPlusSettings settings);

    double level() const { return level_; }
    void answer(double level, bool yes);
    bool done() const { return trials_ >= settings_.trials; }
    /// Returns the mean of the threshold's posterior and the quantiles that bound the interval.
    Estimate estimate() const;

    /// mode() returns the most probable point of the grid; mean() returns the mean of each
    /// parameter.
    model::Psychometric mode() const;
    model::Psychometric mean() const;
    /// Returns the entropy of the posterior that is expected after a trial at levels[i] [nat].
    double expected_entropy(size_t i) const;

    const QuestPlusSettings& settings() const { return settings_; }
    /// Posterior indexed by threshold, shape and lapse rate; the last index changes fastest.
    const std::vector<double>& posterior() const { return posterior_; }

  private:
    enum Parameter { kThreshold, kShape, kLapse };

    model::Psychometric function(size_t i) const;
    const std::vector<double>& grid(Parameter parameter) const;
    size_t index(Parameter parameter, size_t i) const;
    std::vector<double> marginal(Parameter parameter) const;
    double information(size_t level) const;
    void choose();

    QuestPlusSettings settings_;
    double level_ = 0;
    int trials_ = 0;
    std::vector<double> posterior_;
    std::vector<double> yes_;      // p_i(x), indexed by level, then by parameters
    std::vector<double> entropy_;  // h(p_i(x))
};

}  // namespace dihaptic::task
