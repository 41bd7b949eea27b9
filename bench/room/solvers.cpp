#include "bench/solvers.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "bench/bullet_problem.h"
#include "bench/duration.h"
#include "bench/solver_problems.h"
#include "contact/solver.h"

namespace dihaptic::bench {
namespace {

using contact::Impulse;
using contact::Solver;

double quantile(std::vector<double> values, double share) {
    if (values.empty()) return std::numeric_limits<double>::quiet_NaN();
    const auto at = static_cast<size_t>(share * static_cast<double>(values.size() - 1) + 0.5);
    std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(at),
                     values.end());
    return values[at];
}

/// Indices of the problems that were solved, and the time of each [us].
struct Times {
    std::vector<size_t> solved;
    std::vector<double> us;
};

/// 0 ... count - 1 in an order whose first part of any length is spread evenly (van der Corput).
std::vector<size_t> spread_over(size_t count) {
    std::vector<size_t> out;
    unsigned bits = 0;
    while ((size_t{1} << bits) < count) ++bits;
    for (size_t i = 0; i < size_t{1} << bits; ++i) {
        size_t reversed = 0;
        for (unsigned bit = 0; bit < bits; ++bit) reversed |= (i >> bit & 1) << (bits - 1 - bit);
        if (reversed < count) out.push_back(reversed);
    }
    return out;
}

/// Finds the number of problems, spread evenly over the scene's time, that half the budget [s]
/// allows; at least one. Then these are solved once more, now in the order of the ticks, so that
/// each finds the caches as the previous problem left them, as in a session. Only the time of this
/// second solve is used: the shortest of several times would falsify a p99.
template <class Solve>
Times times(size_t count, double budget, const Solve& solve) {
    Times out;
    double spent = 0;
    for (const size_t i : spread_over(count)) {
        if (spent > budget / 2) break;
        spent += solve(i) * 1e-6;
        out.solved.push_back(i);
    }
    std::sort(out.solved.begin(), out.solved.end());
    for (const size_t i : out.solved) out.us.push_back(solve(i));
    return out;
}

/// Measures our solvers, and Bullet's, on the problems of one scene.
class Measurement {
  public:
    Measurement(const ProblemGroup& group, double budget) : group_(group), budget_(budget) {
        int bodies = 0;
        int contacts = 0;
        for (const RecordedProblem& p : group.problems) {
            bodies = std::max(bodies, static_cast<int>(p.problem.bodies.size()));
            contacts = std::max(contacts, static_cast<int>(p.problem.contacts.size()));
        }
        solvers_.reserve(bodies, contacts, false);
        measure_bullet();
    }

    const SolverCost& bullet() const { return bullet_; }

    SolverCost measure(Solver solver) {
        SolverCost out = head(enum_name(solver));
        std::vector<Impulse> r;
        std::vector<double> residuals;
        std::vector<char> seen(group_.problems.size());
        const Times all = times(group_.problems.size(), budget_, [&](size_t i) {
            const RecordedProblem& p = group_.problems[i];
            r = p.start;
            contact::SolveStats stats;
            const double us =
                1e6 * duration_of([&] { solvers_.solve(solver, {}, p.problem, r, stats); });
            if (!seen[i]) {
                seen[i] = 1;
                out.fallbacks += stats.fallback ? 1 : 0;
                out.missed += stats.missed ? 1 : 0;
                residuals.push_back(contact::natural_map_residual(p.problem, r));
            }
            return us;
        });
        out.residual_p99 = quantile(residuals, 0.99);
        fill(out, all);
        return out;
    }

    ProblemFigures describe() {
        ProblemFigures out{group_.family, group_.contacts, 0, 0, 0, 0, 0};
        double all = 0;
        out.problems = static_cast<int>(group_.problems.size());
        const size_t stride =
            1 + group_.problems.size() / 50;  // about 50 problems are enough for fractions
        int seen = 0;
        for (size_t i = 0; i < group_.problems.size(); i += stride, ++seen) {
            const RecordedProblem& p = group_.problems[i];
            std::vector<Impulse> r = p.start;
            contact::SolveStats stats;
            solvers_.solve(Solver::newton, {}, p.problem, r, stats);
            double load = 0;
            for (const Impulse& impulse : r) load = std::max(load, impulse[0]);
            for (size_t j = 0; j < r.size(); ++j) {
                constexpr double kNothing = 1e-6;
                const double limit = p.problem.contacts[j].friction * r[j][0];
                if (r[j][0] <= kNothing * load) {
                    ++out.open;
                } else if (r[j].segment<2>(1).norm() >= (1 - kNothing) * limit) {
                    ++out.sliding;
                } else {
                    ++out.sticking;
                }
                ++all;
            }
        }
        for (double* share : {&out.sticking, &out.sliding, &out.open}) *share /= all;
        out.mean_contacts = all / seen;
        return out;
    }

  private:
    SolverCost head(std::string_view solver) const {
        SolverCost out;
        out.solver = solver;
        out.family = group_.family;
        out.contacts = group_.contacts;
        return out;
    }
    void fill(SolverCost& out, const Times& times) const {
        std::vector<double> ratios;
        double contacts = 0;
        for (size_t i = 0; i < times.solved.size(); ++i) {
            ratios.push_back(times.us[i] / bullet_us_[times.solved[i]]);
            contacts +=
                static_cast<double>(group_.problems[times.solved[i]].problem.contacts.size());
        }
        out.ratio_median = quantile(ratios, 0.5);
        out.median_us = quantile(times.us, 0.5);
        out.p99_us = quantile(times.us, 0.99);
        out.solves = static_cast<int>(times.solved.size());
        out.mean_contacts = contacts / out.solves;
    }

    void measure_bullet() {
        btSequentialImpulseConstraintSolver solver;
        std::vector<std::unique_ptr<BulletProblem>> problems;
        for (const RecordedProblem& p : group_.problems)
            problems.push_back(std::make_unique<BulletProblem>(p.problem, p.start));
        const double whole = std::numeric_limits<double>::infinity();
        const Times all = times(problems.size(), whole, [&](size_t i) {
            problems[i]->reset();
            return 1e6 * duration_of([&] { problems[i]->solve(solver, kBulletIterations); });
        });
        std::vector<double> residuals;
        for (size_t i = 0; i < problems.size(); ++i) {
            residuals.push_back(
                contact::natural_map_residual(group_.problems[i].problem, problems[i]->impulses()));
        }
        bullet_ = head(kBulletSolver);
        bullet_.residual_p99 = quantile(residuals, 0.99);
        bullet_us_ = all.us;
        fill(bullet_, all);
    }

    const ProblemGroup& group_;
    double budget_;
    contact::ContactSolvers solvers_;
    std::vector<double> bullet_us_;
    SolverCost bullet_;
};

/// Slope of log y over log x, by least squares.
double exponent(const std::vector<double>& x, const std::vector<double>& y) {
    const auto n = static_cast<double>(x.size());
    double mean_x = 0, mean_y = 0;
    for (size_t i = 0; i < x.size(); ++i) {
        mean_x += std::log(x[i]) / n;
        mean_y += std::log(y[i]) / n;
    }
    double xy = 0, xx = 0;
    for (size_t i = 0; i < x.size(); ++i) {
        xy += (std::log(x[i]) - mean_x) * (std::log(y[i]) - mean_y);
        xx += (std::log(x[i]) - mean_x) * (std::log(x[i]) - mean_x);
    }
    return xy / xx;
}

std::vector<Growth> growth_of(const std::vector<SolverCost>& costs,
                              const std::vector<std::string>& solvers) {
    std::vector<Growth> out;
    for (const std::string& solver : solvers) {
        for (const char* family : {"wall", "pile"}) {
            std::vector<double> contacts, median, p99;
            for (const SolverCost& cost : costs) {
                if (cost.solver != solver || cost.family != family) continue;
                contacts.push_back(cost.mean_contacts);
                median.push_back(cost.median_us);
                p99.push_back(cost.p99_us);
            }
            if (contacts.size() > 1)
                out.push_back(
                    {solver, family, exponent(contacts, median), exponent(contacts, p99)});
        }
    }
    return out;
}

}  // namespace

SolversFigures bench_solvers(const SolversBench& bench, const measure::Progress& progress) {
    constexpr double kRecording = 0.3;  // fraction of the time for recording
    const std::vector<ProblemGroup> groups =
        record_problems(bench.most_problems, [&](const std::string& what, double share) {
            if (progress) progress(what, kRecording * share);
        });
    SolversFigures out;
    std::vector<std::string> solvers{kBulletSolver};
    for (const Solver solver : bench.solvers) solvers.emplace_back(enum_name(solver));
    double done = 0;
    for (const ProblemGroup& group : groups) {
        const auto say = [&](std::string_view solver) {
            if (progress) {
                progress(fmt::format("{}, {} contacts, {}", group.family, group.contacts, solver),
                         kRecording + (1 - kRecording) * done++ /
                                          static_cast<double>(groups.size() * solvers.size()));
            }
        };
        if (group.problems.empty()) continue;
        say(kBulletSolver);
        Measurement measurement(group, bench.budget);
        out.problems.push_back(measurement.describe());
        out.costs.push_back(measurement.bullet());
        for (const Solver solver : bench.solvers) {
            say(enum_name(solver));
            out.costs.push_back(measurement.measure(solver));
        }
    }
    out.growth = growth_of(out.costs, solvers);
    return out;
}

}  // namespace dihaptic::bench
