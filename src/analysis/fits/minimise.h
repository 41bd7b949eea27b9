// Minimises a smooth function of a few bounded variables without derivatives, using NLopt's
// implementation of Powell's BOBYQA (2009), a trust-region method that interpolates earlier points
// with a quadratic. The result is deterministic.
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

/// Minimises `cost` from a starting point within the bounds, to about `tolerance` times the
/// distance between the bounds. `cost` must not throw.
Minimum minimise(const Cost& cost, std::span<const Variable> variables, std::vector<double> start,
                 double tolerance = 1e-7);

/// 95 % quantile of the chi-squared distribution with one degree of freedom, i.e. by how much twice
/// the log likelihood falls at the ends of a 95 % profile interval.
inline constexpr double kChiSquared95 = 3.841458820694124;

struct Interval {
    double low = 0;
    double high = 0;
};

/// Returns the points at which a profile that has its minimum at `best` and rises on both sides
/// crosses `limit`, accurate to half a percent of their distance from `best`. If the profile does
/// not cross `limit` on one side, returns that end of the range instead.
Interval profile_interval(const std::function<double(double)>& profile, double best,
                          const Variable& range, double limit);

}  // namespace dihaptic::analysis
