// Tests the components of solvers: linear complementarity, sparse factorisation, friction polygon,
// acceleration, and the linearised law.
#include <gtest/gtest.h>

#include "contact/anderson.h"
#include "contact/block_lu.h"
#include "contact/delassus_system.h"
#include "contact/stewart_trinkle/lemke.h"
#include "contact/stewart_trinkle/stewart_trinkle.h"
#include "problems.h"

namespace dihaptic::contact::methods_test {
namespace {

TEST(LemkeTest, SolvesProblemsThatEnumerationSolves) {
    Random random(1, "lcp");
    Lemke lemke;
    lemke.reserve(6);
    for (int trial = 0; trial < 200; ++trial) {
        const int n = 1 + trial % 6;
        Eigen::MatrixXd A = Eigen::MatrixXd::Zero(n, n);
        for (double& x : A.reshaped()) x = random.uniform(-1, 1);
        const Eigen::MatrixXd M = A * A.transpose() + 0.01 * Eigen::MatrixXd::Identity(n, n);
        lemke.start(n);
        Eigen::VectorXd q(n);
        for (int i = 0; i < n; ++i) {
            q[i] = random.uniform(-1, 1);
            lemke.q(i) = q[i];
            for (int j = 0; j < n; ++j) lemke.M(i, j) = M(i, j);
        }
        ASSERT_TRUE(lemke.solve(trial % 3));
        // M is positive definite, so there is a unique solution; it is found by trying all sets
        for (int set = 0; set < 1 << n; ++set) {
            Eigen::MatrixXd B = Eigen::MatrixXd::Identity(n, n);
            for (int j = 0; j < n; ++j) {
                if (set >> j & 1) B.col(j) = -M.col(j);
            }
            const Eigen::VectorXd x = B.partialPivLu().solve(q);
            if (x.minCoeff() < -1e-12) continue;
            for (int j = 0; j < n; ++j) EXPECT_NEAR(lemke.z(j), set >> j & 1 ? x[j] : 0, 1e-9);
            break;
        }
        // the active set of a solved problem also solves a slightly different problem
        for (int i = 0; i < n; ++i) lemke.q(i) *= 1.0001;
        if (q.minCoeff() < 0) {
            EXPECT_TRUE(lemke.try_last_basis());
        }
    }
}

TEST(LemkeTest, EndsOnDegenerateAndUnsolvableProblems) {
    Lemke lemke;
    lemke.reserve(4);
    lemke.start(4);  // M = 0: all ratios are equal
    for (int i = 0; i < 4; ++i) lemke.q(i) = -1;
    EXPECT_FALSE(lemke.solve(0));  // no z makes w positive
    lemke.start(4);
    for (int i = 0; i < 4; ++i) {
        lemke.q(i) = -1;
        for (int j = 0; j < 4; ++j) lemke.M(i, j) = 1;  // rank one: ties everywhere
    }
    ASSERT_TRUE(lemke.solve(0));
    EXPECT_NEAR(lemke.z(0) + lemke.z(1) + lemke.z(2) + lemke.z(3), 1, 1e-12);
}

/// A block matrix, and the same matrix in dense form.
struct BothMatrices {
    BlockLu& lu;
    Eigen::MatrixXd A;
    Random& random;

    void begin(int nodes) { A = Eigen::MatrixXd::Identity(6 * nodes, 6 * nodes); }
    void add(int i, int j) {
        BlockLu::Block B;
        for (double& x : B.reshaped()) x = random.uniform(-1, 1);
        if (i == j) B += 10 * BlockLu::Block::Identity();
        lu.block(lu.slot(i, j)) += B;
        A.block<6, 6>(6 * i, 6 * j) += B;
    }
    void solve_and_compare() {
        const auto n = static_cast<int>(A.rows() / 6);
        std::vector<BlockLu::Vector> x(static_cast<size_t>(n));
        Eigen::VectorXd b(6 * n);
        for (int i = 0; i < n; ++i) {
            for (double& value : x[static_cast<size_t>(i)]) value = random.uniform(-1, 1);
            b.segment<6>(6 * i) = x[static_cast<size_t>(i)];
        }
        lu.solve(x);
        const Eigen::VectorXd expected = A.partialPivLu().solve(b);
        for (int i = 0; i < n; ++i)
            EXPECT_LT((x[static_cast<size_t>(i)] - expected.segment<6>(6 * i)).norm(), 1e-10);
    }
};

std::vector<std::pair<int, int>> random_edges(int nodes, Random& random) {
    std::vector<std::pair<int, int>> out;
    for (int i = 1; i < nodes; ++i) {
        out.emplace_back(static_cast<int>(random.uniform(0, i)), i);
        if (i > 2) out.emplace_back(i - 2, i);
    }
    return out;
}

TEST(BlockLuTest, SolvesWhatADenseFactorisationSolves) {
    Random random(2, "block lu");
    BlockLu lu;
    lu.reserve(20, 60);
    BothMatrices both{lu, {}, random};
    for (int n = 1; n <= 20; ++n) {
        const auto edges = random_edges(n, random);
        ASSERT_TRUE(lu.analyse(n, edges));
        lu.set_identity();
        both.begin(n);
        for (int i = 0; i < n; ++i) both.add(i, i);
        for (const auto& [i, j] : edges) {
            both.add(i, j);
            both.add(j, i);
        }
        lu.keep();
        both.solve_and_compare();
    }
}

TEST(BlockLuTest, SolvesAgainWithOtherBlocksOfNodesThatVary) {
    Random random(4, "block lu that varies");
    BlockLu lu;
    lu.reserve(20, 60);
    BothMatrices both{lu, {}, random};
    for (int n = 1; n <= 20; ++n) {
        const auto edges = random_edges(n, random);
        std::vector<char> varies;
        for (int i = 0; i < n; ++i) varies.push_back(random.uniform(0, 1) < 0.5 ? 1 : 0);
        const auto can_vary = [&](int i) { return varies[static_cast<size_t>(i)] != 0; };
        ASSERT_TRUE(lu.analyse(n, edges, varies));
        lu.set_identity();
        both.begin(n);
        for (int i = 0; i < n; ++i) both.add(i, i);
        for (const auto& [i, j] : edges) {
            both.add(i, j);
            both.add(j, i);
        }
        lu.keep();
        const Eigen::MatrixXd kept = both.A;
        for (int again = 0; again < 3; ++again) {
            lu.again();
            both.A = kept;
            for (int i = 0; i < n; ++i) {
                if (can_vary(i)) both.add(i, i);
            }
            for (const auto& [i, j] : edges) {
                if (can_vary(i) && can_vary(j)) both.add(j, i);
            }
            both.solve_and_compare();
        }
    }
}

TEST(BlockLuTest, AChainFillsNothing) {
    BlockLu lu;
    lu.reserve(100, 100);
    std::vector<std::pair<int, int>> chain;
    for (int i = 0; i < 99; ++i) chain.emplace_back(i, i + 1);
    ASSERT_TRUE(lu.analyse(100, chain));
    EXPECT_EQ(lu.blocks(), 100 + 2 * 99);
    EXPECT_FALSE(lu.analyse(101, chain));
}

TEST(PolygonTest, ProjectsToItsNearestPoint) {
    Random random(3, "polygon");
    for (int trial = 0; trial < 300; ++trial) {
        const double angle = random.uniform(-4, 4);
        Polygon<2> polygon{4 + trial % 9};
        polygon.turn_to({std::cos(angle), std::sin(angle)});
        const double radius = random.uniform(0.1, 2);
        const Eigen::Vector2d x(random.uniform(-3, 3), random.uniform(-3, 3));
        const auto on = polygon.project(x, radius);
        double nearest = std::numeric_limits<double>::infinity();
        bool inside = true;
        for (int i = 0; i < polygon.directions; ++i) {
            const Eigen::Vector2d a = radius * polygon.direction(i);
            const Eigen::Vector2d edge = radius * polygon.direction(i + 1) - a;
            const double t = std::clamp(edge.dot(x - a) / edge.squaredNorm(), 0.0, 1.0);
            nearest = std::min(nearest, (x - a - t * edge).norm());
            if (edge[0] * (x - a)[1] - edge[1] * (x - a)[0] < 0) inside = false;
        }
        EXPECT_EQ(on.inside, inside);
        EXPECT_NEAR((on.point - x).norm(), inside ? 0 : nearest, 1e-12);
        if (!inside) {
            const double step = 1e-7;
            const Eigen::Vector2d further = polygon.project(x, radius + step).point;
            EXPECT_LT(((further - on.point) / step - on.per_radius).norm(), 1e-5);
        }
    }
}

TEST(PolygonTest, WithTorsionProjectsToItsNearestPoint) {
    Random random(5, "pyramid");
    const auto vector = [&](double size) {
        return Vec3(random.uniform(-size, size), random.uniform(-size, size),
                    random.uniform(-size, size));
    };
    int facets = 0;
    int edges = 0;
    for (int trial = 0; trial < 1000; ++trial) {
        Polygon<3> polygon{4 + trial % 9};
        polygon.turn_to(vector(1));
        EXPECT_LT((polygon.axes.transpose() * polygon.axes - Mat3::Identity()).norm(), 1e-12);
        const double radius = random.uniform(0.1, 2);
        const Vec3 x = vector(3);
        const auto on = polygon.project(x, radius);
        // on.point is nearest if no part of the convex body lies beyond the plane through it
        double beyond = 0;
        for (int i = 0; i < polygon.count(); ++i) {
            beyond = std::max(beyond, (x - on.point).dot(radius * polygon.direction(i) - on.point));
        }
        EXPECT_LT(beyond, 1e-12);
        // on.point must also belong to the body: it is a combination of the body's vertices
        const auto in = polygon.sector(on.point);
        const Vec3 shares = in.inverse * on.point / radius;
        EXPECT_GT(shares.minCoeff(), -1e-12);
        EXPECT_LT(shares.sum(), 1 + 1e-12);
        if (on.inside) continue;
        facets += on.along.trace() > 1.5;
        edges += on.along.trace() > 0.5 && on.along.trace() < 1.5;
        const double step = 1e-7;
        const Vec3 further = polygon.project(x, radius + step).point;
        EXPECT_LT(((further - on.point) / step - on.per_radius).norm(), 1e-5);
        for (int axis = 0; axis < 3; ++axis) {
            const Vec3 moved = polygon.project(x + step * Vec3::Unit(axis), radius).point;
            EXPECT_LT(((moved - on.point) / step - on.along.col(axis)).norm(), 1e-5);
        }
    }
    EXPECT_GT(facets, 50);
    EXPECT_GT(edges, 50);
}

TEST(PolygonTest, SupportIsItsLargestReach) {
    Random random(6, "support");
    for (int trial = 0; trial < 200; ++trial) {
        Polygon<3> polygon{4 + trial % 9};
        polygon.turn_to(Vec3(random.uniform(-1, 1), random.uniform(-1, 1), 0.1));
        const Vec3 x(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
        double most = 0;
        for (int i = 0; i < polygon.count(); ++i)
            most = std::max(most, polygon.direction(i).dot(x));
        EXPECT_NEAR(polygon.support(x), most, 1e-12);
    }
}

TEST(AndersonTest, SolvesALinearIterationInAsManyStepsAsItHasUnknowns) {
    const Eigen::Matrix3d A{{0.9, 0.05, 0}, {0.02, 0.8, 0.1}, {0, 0.3, 0.6}};
    const Eigen::Vector3d b(1, 2, 3);
    const Eigen::Vector3d solution = (Eigen::Matrix3d::Identity() - A).inverse() * b;
    Anderson anderson;
    anderson.reserve(3);
    anderson.start(3);
    std::vector<double> x(3, 0.0);
    for (int i = 0; i < 5; ++i) {
        const Eigen::Vector3d g = A * Eigen::Map<Eigen::Vector3d>(x.data()) + b;
        anderson.advance(x, {g[0], g[1], g[2]});
    }
    EXPECT_LT((Eigen::Map<Eigen::Vector3d>(x.data()) - solution).norm(), 1e-8);
}

/// Checks G and c of a law against finite differences of its equation: the solution of (I + G W) d
/// = -c must be Newton's step.
template <int D, class Law>
void check_linearisation(const Law& law, uint64_t seed) {
    using Vec = Eigen::Matrix<double, D, 1>;
    using Tangent = Eigen::Matrix<double, D - 1, 1>;
    using Square = Eigen::Matrix<double, D, D>;
    Random random(seed, "law");
    for (int trial = 0; trial < 500; ++trial) {
        const Scale scale{random.uniform(0.1, 1.5), random.uniform(0.5, 2), random.uniform(0.5, 2)};
        const double rho = std::pow(10, random.uniform(-3, 0));
        Vec r;
        Vec u;
        r[0] = random.uniform(-0.5, 2);
        for (int i = 1; i < D; ++i) r[i] = random.uniform(-1, 1);
        for (int i = 0; i < D; ++i) u[i] = random.uniform(-1, 1);
        const auto phi = [&](const Vec& at_r, const Vec& at_u) {
            const double g = std::max(0.0, at_r[0] - scale.a_n * at_u[0]);
            Vec out;
            out[0] = at_r[0] - g;
            const Tangent z = at_r.template tail<D - 1>() - scale.a_t * at_u.template tail<D - 1>();
            out.template tail<D - 1>() =
                at_r.template tail<D - 1>() - law.project_tangent(z, scale.mu * g);
            return out;
        };
        Square A;
        Square B;
        const double step = 1e-7;
        for (int i = 0; i < D; ++i) {
            const Vec d = step * Vec::Unit(i);
            A.col(i) = (phi(r, u + d) - phi(r, u - d)) / (2 * step);
            B.col(i) = (phi(r + d, u) - phi(r - d, u)) / (2 * step);
        }
        Linearised<D> l;
        law.law.template linearise<D>(scale, r, u, rho, l, 0);
        const Square K = (B + rho * A).inverse();
        EXPECT_LT((l.G - K * A).norm(), 1e-4 * (1 + l.G.norm())) << trial;
        EXPECT_LT((l.c - K * phi(r, u)).norm(), 1e-4 * (1 + l.c.norm())) << trial;
    }
}

TEST(Law, CoulombsLinearisationIsItsDerivative) {
    struct {
        law::Coulomb law;
        Eigen::Vector2d project_tangent(const Eigen::Vector2d& z, double radius) const {
            return z.norm() <= radius ? z : Eigen::Vector2d(radius * z.normalized());
        }
    } cone;
    check_linearisation<3>(cone, 1);
}

TEST(Law, ThePolygonsLinearisationIsItsDerivative) {
    Polygon<2> polygon{8};
    polygon.turn_to({std::cos(0.3), std::sin(0.3)});
    struct {
        law::Polygonal<2> law;
        Eigen::Vector2d project_tangent(const Eigen::Vector2d& z, double radius) const {
            return law.polygon[0].project(z, radius).point;
        }
    } of_polygon{{std::span(&polygon, 1)}};
    check_linearisation<3>(of_polygon, 2);
}

TEST(Law, ThePolygonsLinearisationWithTorsionIsItsDerivative) {
    Polygon<3> polygon{8};
    polygon.turn_to({0.3, 0.8, -0.4});
    struct {
        law::Polygonal<3> law;
        Vec3 project_tangent(const Vec3& z, double radius) const {
            return law.polygon[0].project(z, radius).point;
        }
    } of_pyramid{{std::span(&polygon, 1)}};
    check_linearisation<4>(of_pyramid, 3);
}

TEST(StewartTrinkleTest, LemkeAloneSolvesGrasps) {
    Random random(4, "lemke alone");
    int solved = 0;
    for (int i = 0; i < 50; ++i) {
        const DelassusProblem problem =
            delassus(testing::random_problem(random, 1 + i % 3, 1 + i % 6));
        DelassusSystem system;
        system.assemble(problem);
        Work work;
        system.count_in(work);
        StewartTrinkleMemory<DelassusSystem> memory;
        memory.reserve(system.size(), system.size());
        StewartTrinkle<DelassusSystem> method(system, {8, DirectionFrame::fixed}, kTolerance,
                                              memory);
        std::vector<Vec3> r(system.size(), Vec3::Zero());
        const StewartTrinkleOutcome out = method.solve_by_lemke(r);
        if (!out.converged) continue;
        ++solved;
        EXPECT_EQ(out.route, Route::lemke);
        EXPECT_LE(out.lcp_residual, kTolerance);
    }
    EXPECT_GE(solved, 48);
}

}  // namespace
}  // namespace dihaptic::contact::methods_test
