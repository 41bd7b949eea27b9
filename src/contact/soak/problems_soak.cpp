// Solves a hundred thousand random contact problems, each starting from zero impulses; no solver
// was tuned on these problems. Counts how often each solver falls back on the next one, and how
// often no solver meets the tolerance.
#include <gtest/gtest.h>

#include "contact/test/problems.h"

namespace dihaptic::contact {
namespace {

struct Case {
    Solver solver;
    bool torsion;
};

class Problems : public ::testing::TestWithParam<Case> {};
INSTANTIATE_TEST_SUITE_P(Soak, Problems,
                         ::testing::Values(Case{Solver::newton, false}, Case{Solver::newton, true},
                                           Case{Solver::staggered_projections, false},
                                           Case{Solver::stewart_trinkle, false},
                                           Case{Solver::stewart_trinkle, true}),
                         [](const auto& of) {
                             return std::string(enum_names(
                                        Solver{})[static_cast<size_t>(of.param.solver)]) +
                                    (of.param.torsion ? "_torsion" : "");
                         });

/// Solves `count` problems with the solver of this test case, each starting from zero impulses, and
/// passes each problem, its answer and its statistics to `judge`.
template <class Judge>
void solve_each(int count, uint64_t seed, const Case& of, const Judge& judge) {
    Random random(seed, "thrown together");
    ContactSolvers solvers;
    solvers.reserve(6, 24, true);
    std::vector<Impulse> r;
    for (int i = 0; i < count; ++i) {
        const ContactProblem problem =
            testing::random_problem(random, 1 + i % 6, 1 + i % 24, of.torsion ? 0.005 : 0);
        r.assign(problem.contacts.size(), Impulse::Zero());
        SolveStats stats;
        solvers.solve(of.solver, {}, problem, r, stats);
        judge(problem, r, stats);
    }
}

TEST_P(Problems, AreAnswered) {
    constexpr int kProblems = 100'000;
    int fallbacks = 0;
    int missed = 0;
    solve_each(kProblems, 2012, GetParam(),
               [&](const ContactProblem&, const std::vector<Impulse>&, const SolveStats& stats) {
                   fallbacks += stats.fallback;
                   missed += stats.missed;
               });
    std::printf("%d problems: %d fallbacks, %d missed\n", kProblems, fallbacks, missed);
    EXPECT_LE(fallbacks, kProblems / (GetParam().solver == Solver::newton ? 1000 : 100));
    EXPECT_LE(missed, kProblems / 10'000);
}

/// How far a contact's friction is outside its cone, relative to the radius of the cone.
double outside(const ProblemContact& contact, const Impulse& r) {
    const double radius = contact.friction * r[0];
    const double friction = r.segment<2>(1).norm();
    return friction > radius * (1 + 1e-12) ? friction / radius - 1 : 0;
}

/// With an answer outside the cone, a finger could pull where it must not.
TEST_P(Problems, KeepFrictionInTheCone) {
    constexpr int kProblems = 30'000;
    int left = 0;
    double worst = 0;
    solve_each(
        kProblems, 2013, GetParam(),
        [&](const ContactProblem& problem, const std::vector<Impulse>& r, const SolveStats&) {
            double most = 0;
            for (size_t j = 0; j < r.size(); ++j)
                most = std::max(most, outside(problem.contacts[j], r[j]));
            left += most > 0;
            worst = std::max(worst, most);
        });
    std::printf("%d problems: %d left the cone, by %g of its radius at most\n", kProblems, left,
                worst);
    EXPECT_LE(left, kProblems / 1000);
}

}  // namespace
}  // namespace dihaptic::contact
