// Minimises a smooth function of a few bounded variables without derivatives, by Powell's BOBYQA
// (2009), a trust region around a quadratic through earlier points, in NLopt's implementation. The
// result is deterministic.
#pragma once

#include <functional>
#include <span>
#include <vector>

namespace dihaptic::analysis {

struct Variable {
    double low = 0;
    double high = 1;  ///< > low
};

struct Minimum {
    std::vector<double> x;
    double value = 0;
};

using Cost = std::function<double(std::span<const double>)>;

/// Minimises `cost` from a start inside the bounds, to about `tolerance` times the distance between
/// them. `cost` must not throw.
Minimum minimise(const Cost& cost, std::span<const Variable> variables, std::vector<double> start,
                 double tolerance = 1e-7);

/// 95 % point of chi-squared with one degree of freedom: the fall of twice the log likelihood at
/// the ends of a 95 % profile interval.
inline constexpr double kChiSquared95 = 3.841458820694124;

struct Interval {
    double low = 0;
    double high = 0;
};

/// The points where a profile that is least at `best` and rises to both sides passes `limit`, to
/// half a percent of their distance from `best`; an end of the range if the profile does not pass
/// `limit` before it.
Interval profile_interval(const std::function<double(double)>& profile, double best,
                          const Variable& range, double limit);

}  // namespace dihaptic::analysis
