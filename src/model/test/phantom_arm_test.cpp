#include "model/phantom_arm.h"

#include <gtest/gtest.h>

#include "base/random.h"
#include "base/unit.h"

namespace dihaptic::model::phantom_arm_test {
namespace {

const PhantomLinks kLinks{0.215, 0.17};

/// Returns random joint angles within the limits.
Vec3 some_joints(Random& random) {
    const PhantomLimits& limits = phantom_limits();
    for (;;) {
        Vec3 q;
        for (int i = 0; i < 3; ++i) q[i] = random.uniform(limits.low[i], limits.high[i]);
        if (phantom_allows(q)) return q;
    }
}

TEST(PhantomArm, HasItsEndpointAtTheOriginInTheResetPose) {
    EXPECT_EQ(phantom_position(kLinks, Vec3::Zero()), Vec3::Zero());
    // positive angles move the turret to the right, the thigh up, and the shin toward the person
    EXPECT_GT(phantom_position(kLinks, {0.1, 0, 0}).x(), 0);
    EXPECT_GT(phantom_position(kLinks, {0, 0.1, 0}).y(), 0);
    EXPECT_NEAR(phantom_position(kLinks, {0, 0, 90 * kDegree}).z(), kLinks.shin, 1e-15);
}

TEST(PhantomArm, JacobianIsThatOfFiniteDifferences) {
    Random random(1, "jacobian");
    constexpr double kStep = 1e-6;
    for (int n = 0; n < 1000; ++n) {
        const Vec3 q = some_joints(random);
        const Mat3 J = phantom_jacobian(kLinks, q);
        for (int i = 0; i < 3; ++i) {
            const Vec3 step = kStep * Vec3::Unit(i);
            const Vec3 slope =
                (phantom_position(kLinks, q + step) - phantom_position(kLinks, q - step)) /
                (2 * kStep);
            EXPECT_LT((J.col(i) - slope).norm(), 1e-9);
        }
        EXPECT_NEAR(std::abs(J.determinant()), phantom_determinant(kLinks, q), 1e-15);
        const Vec3 turning(0.5, -0.8, 1.1);
        const Vec3 bent = (phantom_jacobian(kLinks, q + kStep * turning) -
                           phantom_jacobian(kLinks, q - kStep * turning)) /
                          (2 * kStep) * turning;
        EXPECT_LT((phantom_steady_acceleration(kLinks, q, turning) - bent).norm(), 1e-9);
        // the power of a force at the endpoint equals the power of its joint torques
        const Vec3 f(1, -2, 3), rate(0.3, 0.1, -0.7);
        EXPECT_NEAR((J.transpose() * f).dot(rate), f.dot(J * rate), 1e-15);
    }
}

TEST(PhantomArm, FindsTheJointAnglesOfItsEndpoint) {
    Random random(2, "inverse");
    for (int n = 0; n < 1000; ++n) {
        const Vec3 q = some_joints(random);
        const Vec3 p = phantom_position(kLinks, q);
        EXPECT_LT((phantom_joints(kLinks, p) - q).norm(), 1e-9);
        EXPECT_TRUE(phantom_reaches(kLinks, p));
    }
    EXPECT_FALSE(phantom_reaches(kLinks, {0, 0, 0.3}));
    EXPECT_FALSE(phantom_reaches(kLinks, {0, 0.17, -0.2}));  // too close to the shoulder
    const Vec3 far = phantom_joints(kLinks, {0, 0.17, 1});
    EXPECT_NEAR(phantom_position(kLinks, far).z(), kLinks.shin, 1e-12);  // stretched out
}

TEST(PhantomArm, HasTheMassesThatWerePublished) {
    const PhantomDynamics arm = PhantomDynamics::premium_1_5();
    const Mat3 M = phantom_mass_matrix(arm, Vec3::Zero());
    EXPECT_NEAR(M(0, 0), 35.7e-4, 0.05e-4);
    EXPECT_NEAR(M(1, 1), 24.3e-4, 0.05e-4);
    EXPECT_NEAR(M(2, 2), 9.3e-4, 0.05e-4);
    EXPECT_EQ(M(1, 2), 0);
    EXPECT_NEAR(arm.g_thigh, -0.0163, 5e-5);
    EXPECT_NEAR(arm.g_shin, -0.0738, 5e-5);
    const PhantomDynamics same = PhantomDynamics::scaled(kLinks);
    EXPECT_NEAR(same.m0, arm.m0, 1e-15);
}

TEST(PhantomArm, OfAPremium10IsLighterThanItsDataSheetSays) {
    const PhantomLinks links;
    const Mat3 M = phantom_mass_matrix(PhantomDynamics::scaled(links), Vec3::Zero());
    EXPECT_LT(M(0, 0) / (links.thigh * links.thigh), 0.075);
    EXPECT_LT(M(1, 1) / (links.thigh * links.thigh), 0.075);
    EXPECT_LT(M(2, 2) / (links.shin * links.shin), 0.075);
    EXPECT_GT(M(2, 2) / (links.shin * links.shin), 0.01);
}

TEST(PhantomArm, HasInertiaInEveryPose) {
    Random random(3, "mass");
    const PhantomDynamics arm = PhantomDynamics::premium_1_5();
    for (int n = 0; n < 1000; ++n) {
        const Mat3 M = phantom_mass_matrix(arm, some_joints(random));
        EXPECT_GT(Eigen::SelfAdjointEigenSolver<Mat3>(M).eigenvalues().minCoeff(), 1e-5);
    }
}

TEST(PhantomArm, CoriolisTermsAreTheChristoffelSymbols) {
    Random random(4, "coriolis");
    const PhantomDynamics arm = PhantomDynamics::premium_1_5();
    constexpr double kStep = 1e-6;
    for (int n = 0; n < 200; ++n) {
        const Vec3 q = some_joints(random);
        const Vec3 rate(random.normal(), random.normal(), random.normal());
        Vec3 expected = Vec3::Zero();  // M' q' - d(q' M q' / 2)/dq
        for (int k = 0; k < 3; ++k) {
            const Vec3 step = kStep * Vec3::Unit(k);
            const Mat3 slope =
                (phantom_mass_matrix(arm, q + step) - phantom_mass_matrix(arm, q - step)) /
                (2 * kStep);
            expected += rate[k] * slope * rate;
            expected[k] -= rate.dot(slope * rate) / 2;
        }
        EXPECT_LT((phantom_coriolis(arm, q, rate) - expected).norm(), 1e-9);
    }
}

TEST(PhantomArm, GravityIsTheSlopeOfPotentialEnergy) {
    const PhantomDynamics arm = PhantomDynamics::premium_1_5();
    const Vec3 q(0.3, 0.5, -0.4);
    constexpr double kStep = 1e-6;
    for (int i = 0; i < 3; ++i) {
        const Vec3 step = kStep * Vec3::Unit(i);
        const double slope = (phantom_energy(arm, q + step, Vec3::Zero()) -
                              phantom_energy(arm, q - step, Vec3::Zero())) /
                             (2 * kStep);
        EXPECT_NEAR(phantom_gravity(arm, q)[i], slope, 1e-9);
    }
    EXPECT_EQ(phantom_energy(arm, Vec3::Zero(), Vec3::Zero()), 0);
}

}  // namespace
}  // namespace dihaptic::model::phantom_arm_test
