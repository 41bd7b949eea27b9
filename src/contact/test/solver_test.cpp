// Tests all solvers through their interface: against closed forms and an independent reference, for
// invariance, and for results that must not occur.
#include <gtest/gtest.h>

#include <functional>

#include "base/unit.h"
#include "problems.h"
#include "testing/allocation_guard.h"

namespace dihaptic::contact::solver_test {
namespace {

using testing::answer;
using testing::Answer;
using testing::block_on_plane;
using testing::random_problem;

class EachSolver : public ::testing::TestWithParam<Solver> {};
INSTANTIATE_TEST_SUITE_P(Contact, EachSolver,
                         ::testing::Values(Solver::stewart_trinkle, Solver::staggered_projections,
                                           Solver::newton),
                         [](const auto& which) {
                             return std::string(
                                 enum_names(Solver{})[static_cast<size_t>(which.param)]);
                         });

Vec3 tilted(double slope, double turn) {
    return {std::sin(slope) * std::cos(turn), std::sin(slope) * std::sin(turn), std::cos(slope)};
}

TEST_P(EachSolver, HoldsABlockOnASlopeBelowTheFrictionAngle) {
    for (double turn = 0; turn < 1.5; turn += 0.2) {
        const ContactProblem problem = block_on_plane(tilted(26 * kDegree, turn), 0.5);
        const Answer a = answer(GetParam(), problem);
        EXPECT_LT((problem.bodies[0].v_W + a.change[0].head<3>()).norm(), 1e-10);
        EXPECT_LT(a.change[0].tail<3>().norm(), 1e-8);
    }
}

TEST_P(EachSolver, SlidesDownTheFallLineAsCoulombSays) {
    const double slope = 30 * kDegree;
    for (double turn = 0; turn < 1.5; turn += 0.1) {
        const ContactProblem problem = block_on_plane(tilted(slope, turn), 0.5);
        const Answer a = answer(GetParam(), problem);
        const Vec3 v = problem.bodies[0].v_W + a.change[0].head<3>();
        const double expected = 9.81e-3 * (std::sin(slope) - 0.5 * std::cos(slope));
        EXPECT_NEAR(v.norm(), expected, 1e-8);
        const Vec3 fall = Vec3(std::cos(slope) * std::cos(turn), std::cos(slope) * std::sin(turn),
                               -std::sin(slope));
        EXPECT_NEAR(v.dot(fall), expected, 1e-8);
    }
}

TEST(StewartTrinkle, SlidesByItsPolygonWhenDirectionsAreFixed) {
    // halfway between two of n directions, the effective friction is mu cos(pi / n)
    const double slope = 30 * kDegree;
    for (const int n : {4, 8, 16}) {
        ContactProblem problem = block_on_plane(tilted(slope, 0), 0.5);
        const double half = std::numbers::pi / n;
        for (ProblemContact& contact : problem.contacts) {
            const Vec3 normal = contact.R_WC.col(0);
            const Vec3 fall(std::cos(slope), 0, -std::sin(slope));
            contact.R_WC.col(1) = Eigen::AngleAxisd(half, normal) * fall;
            contact.R_WC.col(2) = normal.cross(contact.R_WC.col(1));
        }
        const Answer a = answer(Solver::stewart_trinkle, problem, {n, DirectionFrame::fixed});
        EXPECT_FALSE(a.stats.fallback);
        EXPECT_LE(a.detail.lcp_residual, 1e-8);
        const Vec3 v = problem.bodies[0].v_W + a.change[0].head<3>();
        EXPECT_NEAR(v.norm(), 9.81e-3 * (std::sin(slope) - 0.5 * std::cos(half) * std::cos(slope)),
                    1e-8)
            << n;
    }
}

TEST(StewartTrinkle, LeavesTheFallLineOnlyWhenDirectionsAreFixed) {
    // not aligned: the fall line is at 15 degrees to the first of four directions
    const double slope = 30 * kDegree;
    const Vec3 fall(std::cos(slope), 0, -std::sin(slope));
    ContactProblem problem = block_on_plane(tilted(slope, 0), 0.5);
    for (ProblemContact& contact : problem.contacts) {
        const Vec3 normal = contact.R_WC.col(0);
        contact.R_WC.col(1) = Eigen::AngleAxisd(15 * kDegree, normal) * fall;
        contact.R_WC.col(2) = normal.cross(contact.R_WC.col(1));
    }
    const auto off_fall_line = [&](DirectionFrame frame) {
        const Answer a = answer(Solver::stewart_trinkle, problem, {4, frame});
        EXPECT_EQ(a.stats.route, Route::own_newton);
        const Vec3 v = problem.bodies[0].v_W + a.change[0].head<3>();
        return std::atan2(v.cross(fall).norm(), v.dot(fall)) / kDegree;
    };
    // a little transverse friction keeps the block sliding at 45 degrees to the directions, two of
    // which are then equally good
    EXPECT_NEAR(off_fall_line(DirectionFrame::fixed), 30, 1e-4);
    EXPECT_LT(off_fall_line(DirectionFrame::sliding), 1e-5);
}

TEST(StewartTrinkle, AnswersByMeansOfItsOwn) {
    // turned polygons lead to Coulomb's law, and fixed ones to the answer of their own problem,
    // with or without torsion
    Random random(9, "random problems");
    for (const DirectionFrame frame : {DirectionFrame::fixed, DirectionFrame::sliding}) {
        for (const double radius : {0.0, 0.005}) {
            int own = 0;
            for (int i = 0; i < 200; ++i) {
                const ContactProblem problem =
                    random_problem(random, 1 + i % 4, 1 + i % 10, radius);
                const Answer a = answer(Solver::stewart_trinkle, problem, {8, frame});
                if (a.stats.fallback) continue;
                EXPECT_TRUE(a.stats.route == Route::start || a.stats.route == Route::own_newton ||
                            a.stats.route == Route::lemke);
                EXPECT_LE(a.detail.lcp_residual, 1e-8);
                if (frame == DirectionFrame::sliding) {
                    EXPECT_LE(natural_map_residual(problem, a.r), 2e-8) << i;
                }
                ++own;
            }
            // with turning polygons, a few problems in a hundred cycle, with torsion even more
            const bool hard = frame == DirectionFrame::sliding && radius > 0;
            EXPECT_GE(own, hard ? 190 : 195)
                << static_cast<int>(frame) << ", torsion radius " << radius;
        }
    }
}

TEST(Routes, AreTold) {
    const ContactProblem slides = block_on_plane(tilted(30 * kDegree, 0.3), 0.5);
    EXPECT_EQ(answer(Solver::newton, slides).stats.route, Route::newton);
    EXPECT_EQ(answer(Solver::stewart_trinkle, slides).stats.route, Route::own_newton);
    EXPECT_EQ(answer(Solver::staggered_projections, slides).stats.route,
              Route::staggered_projections);
    ContactProblem parts = block_on_plane(Vec3::UnitZ(), 0.5);
    parts.bodies[0].v_W = Vec3(0, 0, 1);
    EXPECT_EQ(answer(Solver::newton, parts).stats.route, Route::start);
    EXPECT_EQ(answer(Solver::newton, {}).stats.route, Route::none);

    SolveStats all;
    SolveStats other;
    all.route = Route::start;
    other.route = Route::lemke;
    all.join(other);
    EXPECT_EQ(all.route, Route::lemke);
    other.route = Route::newton;
    other.fallback = true;
    all.join(other);
    EXPECT_EQ(all.route, Route::newton);
}

/// A block between two pads that each press on it with 5 N along x and carry its weight.
ContactProblem pinch(double mu, double press, double torsion_radius, double torque) {
    const double h = 1e-3;
    ContactProblem out;
    out.bodies.push_back(testing::body(0.1, Vec3::Constant(0.1 * 0.04 * 0.04 / 6)));
    out.bodies[0].v_W = Vec3(0, 0, -9.81 * h);
    out.bodies[0].w_W = Vec3(torque * h / (0.1 * 0.04 * 0.04 / 6), 0, 0);
    for (const double side : {-1.0, 1.0}) {
        ProblemBody pad = testing::body(1, Vec3::Ones());
        pad.inverse_mass = Vec6(1 / 1.0, 0, 0, 0, 0, 0).asDiagonal();
        pad.v_W = Vec3(-side * press * h / 1.0, 0, 0);
        out.bodies.push_back(pad);
        ProblemContact contact;
        contact.a = side < 0 ? 1 : 2;
        contact.b = 0;
        contact.R_WC = testing::frame_of(Vec3(-side, 0, 0));
        contact.p_BC_W = Vec3(side * 0.02, 0, 0);
        contact.p_AC_W = Vec3(-side * 0.005, 0, 0);
        contact.friction = mu;
        contact.torsion_radius = torsion_radius;
        out.contacts.push_back(contact);
    }
    return out;
}

TEST_P(EachSolver, BalancesAGrip) {
    const double h = 1e-3;
    const Answer a = answer(GetParam(), pinch(0.8, 5, 0, 0));
    for (const Impulse& r : a.r) {
        EXPECT_NEAR(r[0] / h, 5, 1e-4);
        EXPECT_NEAR(r.segment<2>(1).norm() / h, 0.1 * 9.81 / 2, 1e-6);
    }
}

TEST_P(EachSolver, SoftFingersLetGoAtTheirElliptic) {
    // the moment of each finger can be up to mu r N sqrt(1 - (T / mu N)^2)
    const double mu = 0.8, press = 5, radius = 0.006;
    const double tangential = 0.1 * 9.81 / 2;
    const double limit =
        2 * mu * radius * press * std::sqrt(1 - std::pow(tangential / (mu * press), 2));
    const auto turn = [&](double torque) {
        const ContactProblem problem = pinch(mu, press, radius, torque);
        const Answer a = answer(GetParam(), problem, {32, DirectionFrame::sliding});
        EXPECT_FALSE(a.stats.missed);
        return std::abs(problem.bodies[0].w_W.x() + a.change[0][3]);
    };
    // the limit surface of Stewart-Trinkle is a polytope inside the ellipsoid
    const double share = GetParam() == Solver::stewart_trinkle ? 0.9 : 0.999;
    EXPECT_LT(turn(share * limit), 1e-7);
    EXPECT_GT(turn(1.001 * limit), 1e-5);
}

TEST_P(EachSolver, AnswersRandomProblems) {
    Random random(1, "random problems");
    int fallbacks = 0;
    for (int i = 0; i < 300; ++i) {
        const ContactProblem problem = random_problem(random, 1 + i % 5, 1 + i % 12);
        const Answer a = answer(GetParam(), problem);
        EXPECT_FALSE(a.stats.missed) << i;
        EXPECT_LE(natural_map_residual(problem, a.r), 2e-8) << i;
        EXPECT_EQ(a.stats.residual, a.stats.residual);
        fallbacks += a.stats.fallback;
    }
    EXPECT_LE(fallbacks, GetParam() == Solver::newton ? 0 : 10);
}

TEST_P(EachSolver, AnswersRandomProblemsWithTorsion) {
    Random random(2, "random problems");
    for (int i = 0; i < 100; ++i) {
        const ContactProblem problem = random_problem(random, 1 + i % 4, 1 + i % 8, 0.005);
        const Answer a = answer(GetParam(), problem);
        EXPECT_FALSE(a.stats.missed) << i;
        if (GetParam() == Solver::newton) {
            EXPECT_LE(natural_map_residual(problem, a.r), 1e-8) << i;
        }
    }
}

TEST_P(EachSolver, AgreesWithAnIndependentReference) {
    // velocities are unique even if impulses are not
    Random random(3, "random problems");
    int compared = 0;
    for (int i = 0; i < 40; ++i) {
        const ContactProblem problem = random_problem(random, 1 + i % 3, 1 + i % 6);
        const std::vector<Impulse> reference = testing::reference_solution(problem, 1e-11);
        if (natural_map_residual(problem, reference) > 1e-11)
            continue;  // the reference is too slow for this problem
        const Answer a = answer(GetParam(), problem);
        const DelassusProblem d = delassus(problem);
        Eigen::VectorXd difference(d.q.size());
        for (size_t j = 0; j < reference.size(); ++j) {
            difference.segment<3>(3 * static_cast<Eigen::Index>(j)) =
                (a.r[j] - reference[j]).head<3>();
        }
        // Coulomb friction may have several solutions, which can be assessed only by their residual
        if ((d.W * difference).norm() < 1e-6) ++compared;
        EXPECT_LE(natural_map_residual(problem, a.r), 1e-8);
    }
    EXPECT_GE(compared, 30);
}

/// Makes every other contact soft, from barely soft to far softer than the bodies.
void soften(Random& random, ContactProblem& problem) {
    for (size_t j = 0; j < problem.contacts.size(); j += 2)
        problem.contacts[j].compliance = std::pow(10, random.uniform(-2, 4));
}

TEST_P(EachSolver, PressesASoftContactAsItsSpringSays) {
    // spring k and damper c at the end of the step: m (v+ - v) = -h k (x + h v+) - h c v+
    constexpr double kStep = 1e-3, kMass = 0.1, kX = -0.002;
    for (const double k : {50.0, 1e3, 1e5}) {
        for (const double c : {0.5, 20.0}) {
            for (const double v : {-0.3, 0.0, 0.02}) {
                ContactProblem problem = block_on_plane(Vec3::UnitZ(), 0.5);
                problem.bodies[0].v_W = Vec3(0, 0, v);
                for (ProblemContact& contact : problem.contacts) {
                    contact.compliance = 4 / (kStep * (c + kStep * k));
                    contact.bias = kStep * k / 4 * kX * contact.compliance;
                }
                const Answer a = answer(GetParam(), problem);
                const double expected =
                    (kMass * v - kStep * k * kX) / (kMass + kStep * c + kStep * kStep * k);
                // a contact that separates does not pull
                EXPECT_NEAR(v + a.change[0][2], std::max(v, expected), 1e-8)
                    << k << " " << c << " " << v;
            }
        }
    }
}

TEST_P(EachSolver, AnswersRandomProblemsWithSoftContacts) {
    Random random(4, "random problems");
    for (int i = 0; i < 300; ++i) {
        ContactProblem problem =
            random_problem(random, 1 + i % 5, 1 + i % 12, i % 3 == 0 ? 0.005 : 0);
        soften(random, problem);
        const Answer a = answer(GetParam(), problem);
        EXPECT_FALSE(a.stats.missed) << i;
        if (GetParam() == Solver::newton) {
            EXPECT_LE(natural_map_residual(problem, a.r), 1e-8) << i;
        }
    }
}

TEST_P(EachSolver, AgreesWithAnIndependentReferenceOnSoftContacts) {
    Random random(5, "random problems");
    int compared = 0;
    for (int i = 0; i < 40; ++i) {
        ContactProblem problem = random_problem(random, 1 + i % 3, 1 + i % 6);
        soften(random, problem);
        const std::vector<Impulse> reference = testing::reference_solution(problem, 1e-11);
        if (natural_map_residual(problem, reference) > 1e-11)
            continue;  // the reference is too slow for this problem
        const Answer a = answer(GetParam(), problem);
        for (size_t j = 0; j < reference.size(); ++j) {
            if (problem.contacts[j].compliance > 0) {
                EXPECT_NEAR(a.r[j][0], reference[j][0], 1e-5 * (1 + reference[j][0])) << i;
            }
        }
        ++compared;
    }
    EXPECT_GE(compared, 10);
}

TEST_P(EachSolver, DoesNotCareHowTheWorldIsTurned) {
    Random random(4, "random problems");
    for (int i = 0; i < 50; ++i) {
        const ContactProblem problem = random_problem(random, 2, 4);
        const Mat3 R = Quat(Eigen::AngleAxisd(random.uniform(0, 3),
                                              Vec3(1, random.uniform(-1, 1), 0.3).normalized()))
                           .toRotationMatrix();
        ContactProblem turned = problem;
        for (ProblemBody& body : turned.bodies) {
            Mat6 both = Mat6::Zero();
            both.topLeftCorner<3, 3>() = both.bottomRightCorner<3, 3>() = R;
            body.inverse_mass = both * body.inverse_mass * both.transpose();
            body.v_W = R * body.v_W;
            body.w_W = R * body.w_W;
        }
        for (ProblemContact& contact : turned.contacts) {
            contact.R_WC = R * contact.R_WC;
            contact.p_AC_W = R * contact.p_AC_W;
            contact.p_BC_W = R * contact.p_BC_W;
        }
        const Answer a = answer(GetParam(), problem);
        const Answer b = answer(GetParam(), turned);
        for (size_t j = 0; j < a.r.size(); ++j) EXPECT_LT((a.r[j] - b.r[j]).norm(), 1e-7);
    }
}

TEST_P(EachSolver, DoesNotCareAboutUnits) {
    Random random(5, "random problems");
    for (const double mass : {1e-3, 1e3}) {
        for (const double length : {1e-3, 1e3}) {
            for (int i = 0; i < 20; ++i) {
                const ContactProblem problem = random_problem(random, 2, 4);
                ContactProblem scaled = problem;
                for (ProblemBody& body : scaled.bodies) {
                    body.inverse_mass.topLeftCorner<3, 3>() /= mass;
                    body.inverse_mass.bottomRightCorner<3, 3>() /= mass * length * length;
                    body.v_W *= length;
                }
                for (ProblemContact& contact : scaled.contacts) {
                    contact.p_AC_W *= length;
                    contact.p_BC_W *= length;
                    contact.bias *= length;
                }
                const Answer a = answer(GetParam(), problem);
                const Answer b = answer(GetParam(), scaled);
                EXPECT_FALSE(b.stats.missed);
                const double unit = mass * length;
                for (size_t j = 0; j < a.r.size(); ++j)
                    EXPECT_LT((a.r[j] - b.r[j] / unit).norm(), 1e-6);
            }
        }
    }
}

TEST_P(EachSolver, KeepsImpulsesInTheConeAndPassesThemOnWhole) {
    Random random(6, "random problems");
    for (int i = 0; i < 50; ++i) {
        const ContactProblem problem = random_problem(random, 3, 8);
        const Answer a = answer(GetParam(), problem);
        Vec3 momentum = Vec3::Zero();
        for (size_t k = 0; k < problem.bodies.size(); ++k)
            momentum += problem.bodies[k].inverse_mass.topLeftCorner<3, 3>().inverse() *
                        a.change[k].head<3>();
        for (size_t j = 0; j < a.r.size(); ++j) {
            const ProblemContact& contact = problem.contacts[j];
            EXPECT_GE(a.r[j][0], 0);
            EXPECT_LE(a.r[j].segment<2>(1).norm(), contact.friction * a.r[j][0] * (1 + 1e-12));
            if (contact.a == kFixed) momentum -= contact.R_WC * a.r[j].head<3>();
        }
        EXPECT_LT(momentum.norm(), 1e-12);
    }
}

TEST_P(EachSolver, TakesOddProblems) {
    const auto fine = [&](const ContactProblem& problem) {
        const Answer a = answer(GetParam(), problem);
        EXPECT_FALSE(a.stats.missed);
        for (const Impulse& r : a.r) EXPECT_TRUE(r.allFinite());
    };
    fine({});
    fine(block_on_plane(Vec3::UnitZ(), 0));
    fine(block_on_plane(Vec3::UnitZ(), 100));
    ContactProblem still = block_on_plane(Vec3::UnitZ(), 0.8);
    still.bodies[0].v_W.setZero();
    fine(still);
    ContactProblem twice = block_on_plane(Vec3::UnitZ(), 0.8);  // every contact is duplicated
    for (size_t j = 0; j < 4; ++j) twice.contacts.push_back(twice.contacts[j]);
    fine(twice);
    ContactProblem held = block_on_plane(Vec3::UnitZ(), 0.8);  // the block can only rise
    held.bodies[0].inverse_mass = Vec6(0, 0, 10, 0, 0, 0).asDiagonal();
    fine(held);
    ContactProblem heavy = block_on_plane(Vec3::UnitZ(), 0.8);  // a mass of one gram under a ton
    heavy.bodies.push_back(testing::body(1000, Vec3::Constant(100)));
    heavy.bodies[1].v_W = Vec3(0, 0, -0.01);
    ProblemContact top;
    top.a = 0;
    top.b = 1;
    top.p_AC_W = Vec3(0, 0, 0.02);
    top.p_BC_W = Vec3(0, 0, -0.02);
    top.R_WC = testing::frame_of(Vec3::UnitZ());
    top.friction = 0.5;
    heavy.contacts.push_back(top);
    fine(heavy);
}

TEST_P(EachSolver, StopsAtAnEasyProblemThatItAlreadySolved) {
    const ContactProblem problem = block_on_plane(tilted(0.2, 0.3), 0.5);
    ContactSolvers solvers;
    solvers.reserve(1, 4, false);
    std::vector<Impulse> r(4, Impulse::Zero());
    SolveStats stats;
    solvers.solve(GetParam(), {}, problem, r, stats);
    EXPECT_GT(stats.iterations, 0);
    solvers.solve(GetParam(), {}, problem, r, stats);
    EXPECT_EQ(stats.iterations, 0);
}

TEST_P(EachSolver, LeavesAProblemThatIsLargerThanItsMemoryToSweeps) {
    ContactSolvers solvers;
    solvers.reserve(1, 3, false);
    Random random(11, "random problems");
    const ContactProblem problem = random_problem(random, 2, 5);
    std::vector<Impulse> r(5, Impulse::Zero());
    SolveStats stats;
    solvers.solve(GetParam(), {}, problem, r, stats);
    EXPECT_TRUE(stats.fallback);
    EXPECT_FALSE(stats.ended);
    EXPECT_EQ(stats.route, Route::sequential_impulse);
    EXPECT_LT(natural_map_residual(problem, r), 1e-3);
}

TEST_P(EachSolver, EndsBySweepsWhereItsWorkIsBounded) {
    Random random(12, "random problems");
    ContactSolvers solvers;
    solvers.reserve(6, 24, false);
    int ended = 0;
    for (int i = 0; i < 60; ++i) {
        const ContactProblem problem = random_problem(random, 6, 24);
        SolveSettings settings;
        settings.work = i % 2 == 0 ? 100 : 24 * kVisitsPerStep * kFewestSteps;
        std::vector<Impulse> r(24, Impulse::Zero());
        SolveStats stats;
        solvers.solve(GetParam(), settings, problem, r, stats);
        EXPECT_EQ(stats.ended, stats.route == Route::sequential_impulse);
        EXPECT_EQ(stats.ended || stats.route == Route::staggered_projections,
                  stats.fallback || GetParam() == Solver::staggered_projections);
        EXPECT_TRUE(stats.ended || !stats.missed);
        if (i % 2 == 0) {
            EXPECT_TRUE(stats.ended);
            EXPECT_EQ(stats.iterations, kFewestSweeps);
            EXPECT_LE(stats.work, (kFewestSweeps * kVisitsPerSweep + 20) * 24);
        }
        EXPECT_LT(natural_map_residual(problem, r), 0.1);
        ended += stats.ended ? 1 : 0;
    }
    EXPECT_GE(ended, 30);
}

TEST(SequentialImpulse, NearsTheAnswerOfTheOthersWithTorsionToo) {
    Random random(13, "random problems");
    int near = 0;
    for (int i = 0; i < 100; ++i) {
        const ContactProblem problem =
            random_problem(random, 1 + i % 4, 1 + i % 8, i % 2 == 0 ? 0 : 0.005);
        ContactSolvers solvers;
        solvers.reserve(4, 8, true);
        std::vector<Impulse> r(problem.contacts.size(), Impulse::Zero());
        SolveSettings settings;
        settings.sweeps = {5000, 1e-10};
        SolveStats stats;
        solvers.solve(Solver::sequential_impulse, settings, problem, r, stats);
        EXPECT_FALSE(stats.fallback);
        EXPECT_FALSE(stats.ended);
        const double residual = natural_map_residual(problem, r);
        EXPECT_LT(residual, 1e-2) << i;
        near += residual < 1e-5 ? 1 : 0;
    }
    EXPECT_GE(near, 95);  // a few problems in a hundred cycle
}

TEST(Hold, TakesAwayOneMotionAndKeepsTheInertiaOfTheOthers) {
    // a slanted rod that can turn about x alone has the inverse moment 1 / I_xx about x, whatever
    // its products of inertia
    const Mat3 R = Quat(Eigen::AngleAxisd(0.7, Vec3(1, 2, 3).normalized())).toRotationMatrix();
    const Mat3 I = R * Vec3(1, 2, 0.1).asDiagonal() * R.transpose();
    Mat6 A = Mat6::Zero();
    A.bottomRightCorner<3, 3>() = I.inverse();
    A.topLeftCorner<3, 3>() = Mat3::Identity();
    for (const int i : {0, 1, 2, 4, 5}) hold(A, i);
    Mat6 expected = Mat6::Zero();
    expected(3, 3) = 1 / I(0, 0);
    EXPECT_LT((A - expected).norm(), 1e-12);
}

TEST_P(EachSolver, AllocatesNothing) {
    DIHAPTIC_NEEDS_ALLOCATION_GUARD();
    Random random(7, "random problems");
    ContactSolvers solvers;
    solvers.reserve(8, 24, true);
    std::vector<Impulse> r;
    r.reserve(24);
    for (int i = 0; i < 60; ++i) {
        const ContactProblem problem =
            random_problem(random, 1 + i % 6, 1 + i % 24, i % 3 == 0 ? 0.004 : 0);
        r.assign(problem.contacts.size(), Impulse::Zero());
        SolveStats stats;
        dihaptic::testing::AllocationGuard guard;
        solvers.solve(
            GetParam(),
            {{8, i % 2 == 0 ? DirectionFrame::fixed : DirectionFrame::sliding}, {}, kUnbounded},
            problem, r, stats);
        EXPECT_EQ(guard.count(), 0u) << i;
    }
}

TEST(StewartTrinkle, SolvesItsOwnProblemWithFixedDirections) {
    Random random(8, "random problems");
    int fallbacks = 0;
    for (int i = 0; i < 200; ++i) {
        const ContactProblem problem = random_problem(random, 1 + i % 4, 1 + i % 10);
        const Answer a = answer(Solver::stewart_trinkle, problem, {8, DirectionFrame::fixed});
        if (a.stats.fallback) {
            ++fallbacks;
            continue;
        }
        EXPECT_LE(a.detail.lcp_residual, 1e-8) << i;
    }
    EXPECT_LE(fallbacks, 2);
}

TEST_P(EachSolver, RefusesWhatIsNoNumberBeforeItStarts) {
    DIHAPTIC_NEEDS_ALLOCATION_GUARD();
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const double infinite = std::numeric_limits<double>::infinity();
    const std::vector<std::function<void(ContactProblem&, double)>> plants{
        [](ContactProblem& p, double x) { p.bodies[0].v_W.x() = x; },
        [](ContactProblem& p, double x) { p.bodies[0].w_W.z() = x; },
        [](ContactProblem& p, double x) { p.bodies[0].inverse_mass(0, 0) = x; },
        [](ContactProblem& p, double x) { p.bodies[0].inverse_mass(4, 4) = x; },
        [](ContactProblem& p, double x) { p.contacts[1].p_BC_W.y() = x; },
        [](ContactProblem& p, double x) { p.contacts[1].R_WC(1, 1) = x; },
        [](ContactProblem& p, double x) { p.contacts[1].bias = x; },
        [](ContactProblem& p, double x) { p.contacts[1].friction = x; },
    };
    for (const bool torsion : {false, true}) {
        ContactSolvers solvers;
        solvers.reserve(4, 16, torsion);
        for (const auto& plant : plants) {
            for (const double x : {nan, infinite, -infinite, 1e200}) {
                ContactProblem problem = block_on_plane({0, 0, 1}, 0.5);
                if (torsion) problem.contacts[0].torsion_radius = 0.01;
                plant(problem, x);
                std::vector<Impulse> r(problem.contacts.size(), Impulse::Constant(1));
                SolveStats stats;
                const dihaptic::testing::AllocationGuard guard;
                solvers.solve(GetParam(), {}, problem, r, stats);
                EXPECT_EQ(guard.count(), 0u);
                EXPECT_TRUE(stats.missed || x == 1e200);
                EXPECT_TRUE(stats.refused || x == 1e200);
                if (!stats.refused) continue;
                EXPECT_EQ(stats.iterations, 0);
                for (const Impulse& impulse : r) EXPECT_EQ(impulse, Impulse::Zero());
            }
        }
    }
}

TEST_P(EachSolver, StartsFromZeroWhereItsStartIsNoNumber) {
    const ContactProblem problem = block_on_plane({0, 0, 1}, 0.5);
    ContactSolvers solvers;
    solvers.reserve(4, 16, false);
    std::vector<Impulse> zero(problem.contacts.size(), Impulse::Zero());
    std::vector<Impulse> r(problem.contacts.size(),
                           Impulse::Constant(std::numeric_limits<double>::quiet_NaN()));
    SolveStats stats, expected;
    solvers.solve(GetParam(), {}, problem, r, stats);
    solvers.solve(GetParam(), {}, problem, zero, expected);
    EXPECT_FALSE(stats.missed);
    for (size_t j = 0; j < r.size(); ++j) EXPECT_EQ(r[j], zero[j]);
}

TEST(Polygon, HasADirectionBeforeAnything) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const double infinite = std::numeric_limits<double>::infinity();
    for (const int n : {4, 8, kMostDirections}) {
        for (const double along : {0.0, 1.0, -7.0, 1e300, nan, infinite}) {
            Polygon<2> polygon{n};
            polygon.turn_to({1.0, along});
            for (const double x : {0.0, 1.0, -1e-300, 1e300, nan, infinite, -infinite}) {
                const int before = polygon.sector({x, -x}).index[0];
                EXPECT_GE(before, 0);
                EXPECT_LT(before, n);
            }
        }
    }
}

}  // namespace
}  // namespace dihaptic::contact::solver_test
