#include "analysis/fits/minimise.h"

#include <nlopt.h>

#include <cmath>
#include <memory>

namespace dihaptic::analysis {
namespace {

/// The cost as a function of variables scaled to [0, 1], so that one tolerance suits all of them.
struct Scaled {
    const Cost& cost;
    std::span<const Variable> variables;
    std::vector<double> x;

    double operator()(const double* unit) {
        for (size_t i = 0; i < x.size(); ++i)
            x[i] = variables[i].low + unit[i] * (variables[i].high - variables[i].low);
        return cost(x);
    }
};

double call(unsigned /*n*/, const double* unit, double* /*gradient*/, void* scaled) {
    return (*static_cast<Scaled*>(scaled))(unit);
}

}  // namespace

Minimum minimise(const Cost& cost, std::span<const Variable> variables, std::vector<double> start,
                 double tolerance) {
    const size_t n = variables.size();
    Scaled scaled{cost, variables, std::move(start)};
    if (n == 0) return {{}, cost({})};
    std::vector<double> unit(n);
    for (size_t i = 0; i < n; ++i)
        unit[i] = (scaled.x[i] - variables[i].low) / (variables[i].high - variables[i].low);

    const std::unique_ptr<nlopt_opt_s, decltype(&nlopt_destroy)> search(
        nlopt_create(NLOPT_LN_BOBYQA, static_cast<unsigned>(n)), &nlopt_destroy);
    nlopt_set_min_objective(search.get(), call, &scaled);
    nlopt_set_lower_bounds1(search.get(), 0);
    nlopt_set_upper_bounds1(search.get(), 1);
    nlopt_set_initial_step1(search.get(), 0.1);
    nlopt_set_xtol_abs1(search.get(), tolerance);
    nlopt_set_maxeval(search.get(), static_cast<int>(2000 * n));
    double value = scaled(unit.data());
    nlopt_optimize(search.get(), unit.data(), &value);
    value = scaled(unit.data());
    return {scaled.x, value};
}

Interval profile_interval(const std::function<double(double)>& profile, double best,
                          const Variable& range, double limit) {
    const auto end = [&](double bound) {
        if (bound == best || profile(bound) <= limit) return bound;
        double inside = best, outside = bound;
        // accurate to half a percent of the distance, because the statistical uncertainty is larger
        // anyway
        for (int i = 0; i < 40 && std::abs(outside - inside) > 0.005 * std::abs(inside - best);
             ++i) {
            const double middle = (inside + outside) / 2;
            (profile(middle) <= limit ? inside : outside) = middle;
        }
        return (inside + outside) / 2;
    };
    return {end(range.low), end(range.high)};
}

}  // namespace dihaptic::analysis
