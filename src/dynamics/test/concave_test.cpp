// Tests bodies that consist of several convex parts.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <numbers>

#include "dynamics/test/blocks.h"
#include "dynamics/world.h"
#include "scene/solid.h"
#include "testing/allocation_guard.h"
#include "testing/files.h"

namespace dihaptic::dynamics::concave_test {
namespace {

constexpr int kSeconds = 1000;  // steps

scene::Body cup(const std::string& rest) {
    return body_from("{name: cup, shape: mesh, file: ../meshes/cup.obj, unit: mm, concave: yes, " +
                     rest + "}");
}

void run(World& world, int steps) {
    for (int i = 0; i < steps; ++i) world.step(kStep);
}

TEST(Concave, ABallFallsIntoACupAndRestsOnItsBottom) {
    World world =
        make({table(), cup("mass_g: 100"),
              body_from("{name: ball, shape: sphere, radius_mm: 10, mass_g: 20, position_mm: "
                        "[5, 3, 60]}")},
             awake());
    run(world, kSeconds);
    const Vec3 ball = world.states()[2].X_WB.p;
    EXPECT_NEAR(ball.z(), 0.004 + 0.010, 2e-4);
    EXPECT_LT(std::hypot(ball.x(), ball.y()), 0.0182);
    EXPECT_LT(world.states()[1].X_WB.p.norm(), 1e-4);
    double carried = 0;
    for (const contact::Contact& c : world.contacts()) {
        if (c.a == BodyIndex{0} || c.b == BodyIndex{0}) carried += c.normal_force;
    }
    EXPECT_NEAR(carried, 0.12 * kGravity, 0.01 * 0.12 * kGravity);
}

TEST(Concave, ACupStandsOverABallThatItWouldCrushWereItSolid) {
    World world = make({table(),
                        body_from("{name: ball, shape: sphere, radius_mm: 10, mass_g: 20, "
                                  "position_mm: [0, 0, 10]}"),
                        cup("mass_g: 100, rotation_deg: [180, 0, 0], position_mm: [0, 0, 80.5]")},
                       awake());
    run(world, 300);
    EXPECT_NEAR(world.states()[2].X_WB.p.z(), 0.080, 2e-5);
    EXPECT_NEAR(world.states()[1].X_WB.p.z(), 0.010, 1e-4);
}

TEST(Concave, AMugHangsOnAHookBelowWhereItsHandleRests) {
    // the handle's bar rests across the bend of the hook; friction lets the mug come to rest below
    const scene::Body mug_body = body_from(
        "{name: mug, shape: compound, mass_g: 150, friction: 0.3, rotation_deg: [0, 0, 90], "
        "position_mm: [16, 45, -61.7], parts: ["
        "{shape: mesh, file: ../meshes/cup.obj, unit: mm, concave: yes}, "
        "{shape: box, size_mm: [24, 8, 6], position_mm: [-42, 0, 65]}, "
        "{shape: box, size_mm: [24, 8, 6], position_mm: [-42, 0, 21]}, "
        "{shape: box, size_mm: [6, 8, 50], position_mm: [-57, 0, 43]}]}");
    World world = make({body_from("{name: hook, shape: mesh, file: ../meshes/hook.obj, unit: mm, "
                                  "concave: yes, fixed: yes, "
                                  "friction: 0.3}"),
                        mug_body});
    run(world, 4 * kSeconds);
    const BodyState& mug = world.states()[1];
    // over a second, the supporting impulse equals the impulse of the mug's weight plus the mug's
    // gain in momentum
    Vec3 impulse = Vec3::Zero();
    const Vec3 centre(solid_of(mug_body.shape, 0.15).X_BM.p);
    const auto momentum = [&] {
        return Vec3(0.15 * (mug.v_WB + mug.w_WB.cross(mug.X_WB.R * centre)));
    };
    const Vec3 before = momentum();
    for (int i = 0; i < kSeconds; ++i) {
        world.step(kStep);
        for (const contact::Contact& c : world.contacts())
            impulse += kStep * (c.b == BodyIndex{1} ? 1.0 : -1.0) * c.f_B_W;
    }
    const Vec3 gained = momentum() - before;
    EXPECT_LT((impulse - Vec3(0, 0, 0.15 * kGravity) - gained).norm(), 1e-6);
    EXPECT_GT(mug.X_WB.p.z(), -0.12);
    // the centre of the mug has come to rest below the hook
    EXPECT_LT((mug.X_WB * centre - Vec3(0.016, 0, (mug.X_WB * centre).z())).norm(), 0.02);
}

/// Returns an OBJ file of a ring about z, in millimetres.
std::string ring(double radius, double thickness, int around, int across) {
    std::string out;
    const auto angle = [](int i, int of) { return 2 * std::numbers::pi * i / of; };
    for (int i = 0; i < around; ++i) {
        for (int j = 0; j < across; ++j) {
            const double r = radius + thickness * std::cos(angle(j, across));
            out += "v " + number_text(r * std::cos(angle(i, around))) + " " +
                   number_text(r * std::sin(angle(i, around))) + " " +
                   number_text(thickness * std::sin(angle(j, across))) + "\n";
        }
    }
    const auto corner = [&](int i, int j) {
        return " " + fmt::format("{}", i % around * across + j % across + 1);
    };
    for (int i = 0; i < around; ++i) {
        for (int j = 0; j < across; ++j)
            out += "f" + corner(i, j) + corner(i + 1, j) + corner(i + 1, j + 1) + corner(i, j + 1) +
                   "\n";
    }
    return out;
}

TEST(Concave, RingsLieOnATableAsTheyFall) {
    // the pieces of these rings have collinear corners, and faces with hardly any area
    for (const auto& [around, across] : {std::pair{16, 8}, {24, 12}}) {
        SCOPED_TRACE(around);
        const testing::TemporaryFolder folder;
        const std::string file = folder.write("ring.obj", ring(30, 8, around, across));
        World world =
            make({table(), body_from("{name: ring, shape: mesh, file: " + file +
                                     ", unit: mm, concave: yes, mass_g: 100, position_mm: "
                                     "[0, 0, 9]}")},
                 awake());
        bool balanced = true;
        for (int i = 0; i < 500; ++i) {
            ASSERT_EQ(world.step(kStep), StepStatus::ok) << i;
            balanced = balanced && !world.balance().unbalanced;
        }
        EXPECT_TRUE(balanced);
        EXPECT_NEAR(world.states()[1].X_WB.p.z(), 0.008, 1e-5);
        double force = 0;
        for (const contact::Contact& c : world.contacts()) force += c.f_B_W.z();
        EXPECT_NEAR(force, 0.1 * kGravity, 1e-6);
    }
}

TEST(Concave, ABallInABowlLosesLessThanItsFacetsTake) {
    // seams between the pieces on the side of the bowl are not felt
    const std::string bowl =
        "{name: bowl, shape: mesh, file: ../meshes/bowl.obj, unit: mm, concave: yes, fixed: yes, "
        "friction: 0}";
    World world =
        make({body_from(bowl), body_from("{name: ball, shape: sphere, radius_mm: 10, mass_g: 20, "
                                         "friction: 0, position_mm: [60, 3, -79]}")},
             awake());
    world.step(kStep);
    const double before = world.balance().energy();
    run(world, kSeconds);
    EXPECT_LT(before - world.balance().energy(), 0.6e-3);  // 0.72e-3 J if seams were felt
}

TEST(Concave, ACompoundTurnsAboutItsCentreOfMass) {
    // in free flight, a dumbbell of unequal boxes falls and keeps its angular momentum
    const scene::Body dumbbell = body_from(
        "{name: d, shape: compound, mass_g: 300, position_mm: [0, 0, 500], parts: ["
        "{shape: box, size_mm: [20, 20, 20], position_mm: [50, 0, 0]}, "
        "{shape: box, size_mm: [20, 20, 10], position_mm: [-50, 0, 0]}]}");
    World world = make({dumbbell});
    world.apply({0}, {0, 0, 0.3 * kGravity}, {0, 0.01, 0.02});
    world.step(kStep);
    const BodyState& state = world.states()[0];
    // 2/3 of the mass is at +50 mm, 1/3 at -50 mm
    const Vec3 centre(0.05 / 3, 0, 0);
    EXPECT_LT((state.v_WB + state.w_WB.cross(state.X_WB.R * centre)).norm(), 1e-9);
    // I_zz = sum m (a^2 + b^2) / 12 + m d^2
    const double izz =
        0.2 * (2 * 4e-4 / 12 + std::pow(0.1 / 3, 2)) + 0.1 * (2 * 4e-4 / 12 + std::pow(0.2 / 3, 2));
    EXPECT_NEAR(state.w_WB.z(), kStep * 0.02 / izz, 1e-9);
}

TEST(Concave, ACompoundTakesTheSamePlaceAsTheBoxThatItMakesUp) {
    const scene::Body halves = body_from(
        "{name: halves, shape: compound, mass_g: 100, position_mm: [0, 0, 20], parts: ["
        "{shape: box, size_mm: [20, 40, 40], position_mm: [10, 0, 0]}, "
        "{shape: box, size_mm: [20, 40, 40], position_mm: [-10, 0, 0]}]}");
    World whole = make({table(), block({0, 0, 0.02})}, awake());
    World made = make({table(), halves}, awake());
    for (int i = 0; i < 500; ++i) {
        // the block slides at mu = 0.8: a = (1.2 - 0.8) g
        for (World* world : {&whole, &made})
            world->apply({1}, {1.2 * 0.1 * kGravity, 0, 0}, Vec3::Zero());
        whole.step(kStep);
        made.step(kStep);
    }
    EXPECT_LT((whole.states()[1].X_WB.p - made.states()[1].X_WB.p).norm(), 1e-6);
    EXPECT_NEAR(made.states()[1].v_WB.x(), 0.4 * kGravity * 0.5, 1e-4);
}

TEST(Concave, ABlockSlidesOverTheSeamOfTwoParts) {
    const scene::Body boards = body_from(
        "{name: boards, shape: compound, fixed: yes, friction: 0.2, parts: ["
        "{shape: box, size_mm: [200, 100, 20], position_mm: [-100, 0, -10]}, "
        "{shape: box, size_mm: [200, 100, 20], position_mm: [100, 0, -10]}]}");
    World world = make({boards, block({-0.08, 0, 0.02}, 0.2)}, awake());
    world.step(kStep);
    world.set_velocity({1}, {0.7, 0, 0});
    run(world, kSeconds);
    // the block stops after v^2 / (2 mu g)
    EXPECT_NEAR(world.states()[1].X_WB.p.x(), -0.08 + 0.49 / (2 * 0.2 * kGravity), 1e-3);
    EXPECT_NEAR(world.states()[1].X_WB.p.z(), 0.02, 1e-5);
}

TEST(Concave, StepsAllocateNothingAndRepeatToTheBit) {
    DIHAPTIC_NEEDS_ALLOCATION_GUARD();
    const auto fill = [] {
        return make(
            {table(), cup("mass_g: 100"),
             body_from("{name: ball, shape: sphere, radius_mm: 10, mass_g: 20, position_mm: [5, "
                       "3, 60]}")},
            awake());
    };
    World first = fill();
    World second = fill();
    run(first, 500);
    second.step(kStep);
    const testing::AllocationGuard guard;
    run(second, 499);
    EXPECT_EQ(guard.count(), 0u);
    for (size_t i = 0; i < first.states().size(); ++i) {
        EXPECT_EQ(first.states()[i].X_WB.p, second.states()[i].X_WB.p);
        EXPECT_EQ(first.states()[i].v_WB, second.states()[i].v_WB);
    }
}

}  // namespace
}  // namespace dihaptic::dynamics::concave_test
