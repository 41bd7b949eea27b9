#include "task/file/draws.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <numeric>

#include "base/number.h"
#include "base/random.h"
#include "base/table.h"
#include "base/text_file.h"
#include "task/plan/streams.h"

namespace dihaptic::task {
namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();
// smallest share of a normal distribution that truncation may leave
constexpr double kLeastShare = 0.01;

double below(double z) {
    return std::erfc(-z / std::sqrt(2.0)) / 2;
}

double exponential(const ExponentialDraw& d, Random& random) {
    const double room = d.to ? -std::expm1(-(*d.to - d.from) / d.mean) : 1;
    const double t = d.from - d.mean * std::log1p(-random.uniform(0, 1) * room);
    return std::min(t, d.to.value_or(kInfinite));
}

double normal(const NormalDraw& d, Random& random) {
    while (true) {
        const double x = d.mean + d.sd * random.normal();
        if (x >= d.from.value_or(-kInfinite) && x <= d.to.value_or(kInfinite)) return x;
    }
}

/// Draws the index of a value, using the weights of the values.
size_t chosen(size_t values, const std::vector<double>& weights, Random& random) {
    if (weights.empty()) {
        const auto i = static_cast<size_t>(random.uniform(0, static_cast<double>(values)));
        return std::min(i, values - 1);
    }
    double left = random.uniform(0, std::accumulate(weights.begin(), weights.end(), 0.0));
    size_t i = 0;
    while (i + 1 < values && left >= weights[i]) left -= weights[i++];
    // prevents rounding from selecting a value of weight 0
    while (i > 0 && weights[i] <= 0) --i;
    return i;
}

double value_at(const std::vector<std::string>& values, size_t i) {
    return are_texts(values) ? static_cast<double>(i) : *finite_number(values[i]);
}

double as_in_tables(double value) {
    return *finite_number(to_csv(Table::Cell(value)));
}

std::vector<double> permuted(const std::vector<std::string>& values, std::span<const int> blocks,
                             Random& random) {
    std::vector<double> out;
    std::vector<size_t> left;
    for (size_t i = 0; i < blocks.size(); ++i) {
        if (i > 0 && blocks[i] != blocks[i - 1]) left.clear();
        if (left.empty()) {
            left.resize(values.size());
            std::iota(left.begin(), left.end(), size_t{0});
        }
        const auto pick =
            left.begin() + static_cast<std::ptrdiff_t>(chosen(left.size(), {}, random));
        out.push_back(as_in_tables(value_at(values, *pick)));
        left.erase(pick);
    }
    return out;
}

class Checker {
  public:
    Checker(const DrawSpec& draw, Diagnostics& diagnostics)
        : draw_(draw), diagnostics_(diagnostics) {}

    void check() {
        const int kinds = draw_.uniform.has_value() + draw_.normal.has_value() +
                          draw_.exponential.has_value() + !draw_.choice.empty() +
                          !draw_.permutation.empty() + draw_.participant;
        if (kinds != 1) {
            error("name",
                  fmt::format("'{}' {}", draw_.name,
                              kinds == 0 ? "draws nothing" : "is drawn in several ways"),
                  "Give it one of 'uniform', 'normal', 'exponential', 'choice', "
                  "'permutation' and 'participant'.");
        }
        if (draw_.uniform) in_order(draw_.uniform->from, draw_.uniform->to);
        if (draw_.exponential) in_order(draw_.exponential->from, draw_.exponential->to);
        if (draw_.normal) check_normal(*draw_.normal);
        check_weights();
    }

  private:
    void error(const std::string& key, const std::string& what, const std::string& remedy) {
        diagnostics_.error(draw_.place, key, what, remedy);
    }
    bool in_order(std::optional<double> from, std::optional<double> to) {
        if (!from || !to || *from < *to) return true;
        error("to", fmt::format("is {:g}, but 'from' is {:g}", *to, *from),
              "Make 'to' greater than 'from'.");
        return false;
    }
    void check_normal(const NormalDraw& d) {
        if (!in_order(d.from, d.to)) return;
        const double share = below((d.to.value_or(kInfinite) - d.mean) / d.sd) -
                             below((d.from.value_or(-kInfinite) - d.mean) / d.sd);
        if (share >= kLeastShare) return;
        error("normal",
              fmt::format("has only {:.2g} of its probability between 'from' and 'to'", share),
              "Move 'from' and 'to' closer to the mean, or increase 'sd'.");
    }
    void check_weights() {
        if (draw_.weights.empty()) return;
        const double sum = std::accumulate(draw_.weights.begin(), draw_.weights.end(), 0.0);
        if (draw_.weights.size() != draw_.choice.size() || sum <= 0) {
            error("weights",
                  fmt::format("there are {} for {} values, with a sum of {:g}",
                              draw_.weights.size(), draw_.choice.size(), sum),
                  "Give each value of 'choice' a weight, not all of them 0.");
        }
    }

    const DrawSpec& draw_;
    Diagnostics& diagnostics_;
};

}  // namespace

bool are_texts(const std::vector<std::string>& values) {
    return std::any_of(values.begin(), values.end(),
                       [](const std::string& value) { return !finite_number(value); });
}

void check(const DrawSpec& draw, Diagnostics& diagnostics) {
    Checker(draw, diagnostics).check();
}

std::vector<double> drawn(const DrawSpec& draw, std::span<const int> blocks, int participant,
                          uint64_t seed) {
    Random random(seed, stream_of("draw " + draw.name, participant));
    if (!draw.permutation.empty()) return permuted(draw.permutation, blocks, random);
    std::vector<double> out;
    for (size_t i = 0; i < blocks.size(); ++i) {
        double value = participant;
        if (draw.uniform) value = random.uniform(draw.uniform->from, draw.uniform->to);
        if (draw.normal) value = normal(*draw.normal, random);
        if (draw.exponential) value = exponential(*draw.exponential, random);
        if (!draw.choice.empty())
            value = value_at(draw.choice, chosen(draw.choice.size(), draw.weights, random));
        out.push_back(as_in_tables(value));
    }
    return out;
}

}  // namespace dihaptic::task
