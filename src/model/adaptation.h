// Trial-by-trial adaptation to a perturbation f, by a single process or by two parallel processes:
//
//     e(n) = f(n) - x(n)        0 in an error clamp
//     x(n+1) = A x(n) + B e(n)
//
// x(n) is the person's compensation in trial n, before learning from that trial, in the unit of f.
// A is the retention and B the learning rate, both in [0, 1]. In the two-rate model, x = x_fast +
// x_slow, where both states are driven by the same e but each has its own A and B, with A_fast <
// A_slow and B_fast > B_slow. Sources: Smith, Ghazizadeh and Shadmehr 2006; single-rate for
// familiar dynamics: Ingram et al. 2011.
#pragma once

#include <span>
#include <vector>

namespace dihaptic::model {

/// A trial, as seen by the model. In washout and catch trials the perturbation is 0, and the person
/// learns from the resulting error. A trial without feedback counts as an error clamp, from which
/// nothing is learned.
struct AdaptationTrial {
    double perturbation = 0;  ///< f
    bool clamp = false;       ///< whether the person never sees an error
};

struct SingleRate {
    double retention = 1;  ///< A
    double learning = 0;   ///< B
};

struct TwoRate {
    SingleRate fast;
    SingleRate slow;
};

struct TwoRateState {
    double fast = 0;
    double slow = 0;
    double output() const { return fast + slow; }
};

/// Estimates by Smith et al. 2006, as quoted in PMC2585408.
inline constexpr TwoRate kSmith2006{.fast = {0.59, 0.21}, .slow = {0.992, 0.02}};

/// Returns the error in a trial for a person with compensation x.
constexpr double adaptation_error(const AdaptationTrial& trial, double x) {
    return trial.clamp ? 0 : trial.perturbation - x;
}

/// Returns the state after a trial with this error.
constexpr double next(const SingleRate& rate, double x, double error) {
    return rate.retention * x + rate.learning * error;
}
constexpr TwoRateState next(const TwoRate& rates, const TwoRateState& state, double error) {
    return {next(rates.fast, state.fast, error), next(rates.slow, state.slow, error)};
}

/// Returns the compensation x in each trial, starting at 0.
std::vector<double> compensation(const SingleRate& rate, std::span<const AdaptationTrial> trials);
std::vector<double> compensation(const TwoRate& rates, std::span<const AdaptationTrial> trials);

/// Returns the fraction of a lasting perturbation that is compensated for in the end: G / (1 + G),
/// where G is the sum of B / (1 - A) over the processes. Returns 1 if a process that learns has a
/// retention of 1.
double asymptote(const SingleRate& rate);
double asymptote(const TwoRate& rates);

}  // namespace dihaptic::model
