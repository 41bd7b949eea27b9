// Trial-by-trial adaptation to a perturbation f, by one process or by two side by side,
//
//     e(n) = f(n) - x(n)        0 in an error clamp
//     x(n+1) = A x(n) + B e(n)
//
// x is what the person compensates for in trial n, in the unit of f, before that trial teaches
// anything. A is the retention and B the learning rate, in [0, 1]. Two-rate: x = x_fast + x_slow,
// each with an A and a B of its own and with the same e; A_fast < A_slow, B_fast > B_slow. Source:
// Smith, Ghazizadeh and Shadmehr 2006; single-rate for familiar dynamics: Ingram et al. 2011.
#pragma once

#include <span>
#include <vector>

namespace dihaptic::model {

/// One trial, as far as adaptation goes. Washout and catch trials have a perturbation of 0, and the
/// error that it makes teaches; a trial without feedback teaches as much as a clamp: nothing.
struct AdaptationTrial {
    double perturbation = 0;  ///< f
    bool clamp = false;       ///< no error is seen, whatever the person does
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

/// Estimates of Smith et al. 2006, as quoted in PMC2585408.
inline constexpr TwoRate kSmith2006{.fast = {0.59, 0.21}, .slow = {0.992, 0.02}};

/// The error that a trial shows to somebody who compensates for x.
constexpr double adaptation_error(const AdaptationTrial& trial, double x) {
    return trial.clamp ? 0 : trial.perturbation - x;
}

/// The state after a trial that showed this error.
constexpr double next(const SingleRate& rate, double x, double error) {
    return rate.retention * x + rate.learning * error;
}
constexpr TwoRateState next(const TwoRate& rates, const TwoRateState& state, double error) {
    return {next(rates.fast, state.fast, error), next(rates.slow, state.slow, error)};
}

/// Compensation x in each of the trials, from none.
std::vector<double> compensation(const SingleRate& rate, std::span<const AdaptationTrial> trials);
std::vector<double> compensation(const TwoRate& rates, std::span<const AdaptationTrial> trials);

/// Share of a lasting perturbation that is compensated for in the end: G / (1 + G) where G is the
/// sum of B / (1 - A). 1 when nothing is ever forgotten.
double asymptote(const SingleRate& rate);
double asymptote(const TwoRate& rates);

}  // namespace dihaptic::model
