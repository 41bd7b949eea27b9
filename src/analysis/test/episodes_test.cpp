// Tests the figures of episodes, using frames for which the figures are known.
#include "analysis/episodes.h"

#include <gtest/gtest.h>

#include <functional>
#include <numbers>

namespace dihaptic::analysis::episodes_test {
namespace {

constexpr double kTick = 1e-3;
constexpr double kMass = 0.1;
constexpr double kFriction = 0.3;
const Vec3 kGravity(0, 0, -9.81);

ObjectFacts facts() {
    return {kMass, kGravity, {kFriction, 0}, {}};
}

/// Returns frame i. Body 0 is the table, body 1 is the object, which nothing touches, and bodies 2
/// to 5 are four fingers.
frame::Frame frame_at(int i) {
    frame::Frame frame;
    frame.sequence = i;
    frame.time = i * std::chrono::milliseconds(1);
    frame.bodies.resize(2);
    frame.fingers.resize(4);
    for (int f = 0; f < 4; ++f)
        frame.fingers[static_cast<size_t>(f)].p_WP = {f % 2 == 0 ? -0.02 : 0.02, 0, 0.01 * f};
    return frame;
}

void press(frame::Frame& frame, int other, const Vec3& n_W = Vec3::UnitZ()) {
    frame::ContactFrame& contact = frame.contacts.emplace_back();
    contact.a = std::min(other, 1);
    contact.b = std::max(other, 1);
    contact.n_W = other < 1 ? n_W : -n_W;
    contact.normal_force = 1;
    contact.p_WC = frame.bodies[1].X_WB.p - 0.02 * n_W;
}

std::vector<Episode> episodes_of(int count, const std::function<void(int, frame::Frame&)>& change,
                                 const ObjectFacts& object = facts()) {
    GraspTrace trace(1, kTick);
    for (int i = 0; i < count; ++i) {
        frame::Frame frame = frame_at(i);
        change(i, frame);
        trace.add(frame);
    }
    return find_episodes(trace, object);
}

/// Returns the episodes of an object that is held and raised at v0 for 0.1 s and then flies for 0.2
/// s, with time steps like those of the World.
std::vector<Episode> thrown(const Vec3& v0, const Vec3& v_hand, const Vec3& gravity) {
    Vec3 p = Vec3::Zero();
    Vec3 v = v0;
    return episodes_of(300, [&](int i, frame::Frame& frame) {
        if (i >= 100) v += kTick * gravity;
        p += kTick * v;
        frame.bodies[1].X_WB.p = p;
        frame.bodies[1].v_WB = v;
        for (const int finger : {2, 3}) {
            if (i < 100) press(frame, finger);
            frame.fingers[static_cast<size_t>(finger - 2)].v_WH =
                v_hand + Vec3(finger == 2 ? -0.4 : 0.4, 0, 0);
        }
    });
}

TEST(Episodes, AFlightIsBallisticAndItsReleaseIsComparedWithTheHand) {
    const Vec3 v(0.3, 0, 1.2);
    const auto found = thrown(v, v / 1.25, kGravity);
    ASSERT_EQ(found.size(), 2u);
    EXPECT_EQ(found[0].kind, rows::EpisodeKind::hold);
    const Episode& flight = found[1];
    EXPECT_EQ(flight.kind, rows::EpisodeKind::flight);
    EXPECT_EQ(flight.fingers, (std::vector<size_t>{0, 1}));
    EXPECT_NEAR(flight.start, 0.1, 1e-12);
    EXPECT_NEAR(flight.release_speed, v.norm(), 1e-12);
    EXPECT_NEAR(flight.release_ratio, 1.25, 1e-12);
    // velocities are those at the middle of the ticks
    EXPECT_NEAR(flight.rise, v.z() * v.z() / (2 * 9.81) - v.z() * kTick / 2, 1e-5);
    EXPECT_LT(flight.off_path, 1e-12);
    EXPECT_TRUE(std::isnan(flight.slip));
    EXPECT_TRUE(std::isnan(flight.friction_ratio));
}

TEST(Episodes, AFlightUnderOtherForcesIsOffTheBallisticPath) {
    const Vec3 wind(0.5, 0, 0);
    const auto found = thrown({0, 0, 1}, {0, 0, 1}, kGravity + wind);
    ASSERT_EQ(found.size(), 2u);
    // the wind's displacement from the parabola through the first two positions: a t (t - h) / 2
    const double t = 0.199;
    EXPECT_NEAR(found[1].off_path, 0.5 * t * (t - kTick) / 2, 1e-5);
}

TEST(Episodes, ABlockThatSlidesOnStopsByFriction) {
    double x = 0;
    double v = 0.5;
    const auto slide = [&](int, frame::Frame& frame) {
        v = std::max(0.0, v - kFriction * 9.81 * kTick);
        x += kTick * v;
        frame.bodies[1].X_WB.p.x() = x;
        frame.bodies[1].v_WB.x() = v;
        press(frame, 0);
    };
    auto found = episodes_of(300, slide);
    ASSERT_EQ(found.size(), 1u);
    EXPECT_EQ(found[0].kind, rows::EpisodeKind::slide);
    EXPECT_TRUE(found[0].fingers.empty());
    EXPECT_NEAR(found[0].distance, 0.25 / (2 * kFriction * 9.81), 1e-3);
    EXPECT_NEAR(found[0].friction_ratio, 1, 1e-9);
    // with half the friction as the expected value, the ratio is 2
    ObjectFacts smoother = facts();
    smoother.friction[0] /= 2;
    x = 0;
    v = 0.5;
    found = episodes_of(300, slide, smoother);
    EXPECT_NEAR(found.at(0).friction_ratio, 2, 1e-9);
}

TEST(Episodes, ABlockThatIsPushedTakesMuMG) {
    // pushed downhill by a force that also presses on the block
    const double slope = 0.4;
    const Vec3 n(std::sin(slope), 0, std::cos(slope));
    const Vec3 along(std::cos(slope), 0, -std::sin(slope));
    const double lean = 0.7;
    const double N = kMass * 9.81 * std::cos(slope) + lean;
    const double push = kFriction * N - kMass * 9.81 * std::sin(slope);
    const auto found = episodes_of(200, [&](int i, frame::Frame& frame) {
        frame.bodies[1].X_WB.p = 0.2 * kTick * i * along;
        frame.bodies[1].v_WB = 0.2 * along;
        frame.fingers[0].f_sent_W = -push * along + lean * n;
        press(frame, 0, n);
        press(frame, 2);
    });
    ASSERT_EQ(found.size(), 1u);
    EXPECT_EQ(found[0].fingers, (std::vector<size_t>{0}));
    EXPECT_NEAR(found[0].distance, 0.2 * 0.199, 1e-12);
    EXPECT_NEAR(found[0].friction_ratio, 1, 1e-9);
}

TEST(Episodes, ABallThatRollsDoesNotSlide) {
    const auto found = episodes_of(200, [](int i, frame::Frame& frame) {
        frame.bodies[1].X_WB.p.x() = 0.2 * kTick * i;
        frame.bodies[1].v_WB.x() = 0.2;
        frame.bodies[1].w_WB.y() = 0.2 / 0.02;
        press(frame, 0);
    });
    EXPECT_TRUE(found.empty());
}

TEST(Episodes, AHoldTurnsWithItsFingersAndSinks) {
    const auto found = episodes_of(1000, [](int i, frame::Frame& frame) {
        const double share = std::min(i, 500) / 500.0;
        const Quat hand = rotation_xyz({0, 0, 0.5 * share});
        frame.bodies[1].X_WB = {rotation_xyz({0, 0, 0.6 * share}), {0, 0, -0.002 * share}};
        frame.fingers[0].p_WP = hand * Vec3(-0.02, 0, 0);
        frame.fingers[1].p_WP = hand * Vec3(0.02, 0, 0);
        press(frame, 2);
        press(frame, 3);
    });
    ASSERT_EQ(found.size(), 1u);
    EXPECT_NEAR(found[0].hand_turn, 0.5, 1e-9);
    EXPECT_NEAR(found[0].turn, 0.6, 1e-9);
    EXPECT_NEAR(found[0].sag, -0.002, 1e-12);
    // the 2 cm arm of each finger was turned by the difference of the angles, and the object sank
    EXPECT_NEAR(found[0].slip, std::hypot(2 * 0.02 * std::sin(0.05), 0.002), 1e-9);
}

TEST(Episodes, AHandOverIsAHoldOfEachHandAndOneOfBoth) {
    const auto found = episodes_of(900, [](int i, frame::Frame& frame) {
        const bool first = i < 600;
        const bool second = i >= 300;
        // a finger lets go for a moment that is too short to count
        const bool flicker = i >= 100 && i < 105;
        if (first && !flicker) press(frame, 2);
        if (first) press(frame, 3);
        if (second) press(frame, 4);
        if (second) press(frame, 5);
        // the first hand slips upward as it lets go
        if (i >= 500) frame.fingers[0].p_WP.z() += 1e-5 * (i - 500);
    });
    ASSERT_EQ(found.size(), 3u);
    EXPECT_EQ(found[0].fingers, (std::vector<size_t>{0, 1}));
    EXPECT_EQ(found[1].fingers, (std::vector<size_t>{0, 1, 2, 3}));
    EXPECT_EQ(found[2].fingers, (std::vector<size_t>{2, 3}));
    EXPECT_NEAR(found[0].end, 0.299, 1e-12);
    EXPECT_NEAR(found[2].start, 0.6, 1e-12);
    EXPECT_NEAR(found[1].slip, 99e-5, 1e-12);
    EXPECT_EQ(found[1].least_slip, 0);
    EXPECT_EQ(found[2].slip, 0);
}

TEST(Episodes, AnObjectAtRestAsleepOrUnknownIsInNone) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    EXPECT_TRUE(episodes_of(200, [](int, frame::Frame& frame) { press(frame, 0); }).empty());
    EXPECT_TRUE(
        episodes_of(200, [](int, frame::Frame& frame) { frame.bodies[1].awake = 0; }).empty());
    EXPECT_TRUE(episodes_of(200, [&](int, frame::Frame& frame) {
                    frame.bodies[1].X_WB.p.setConstant(nan);
                }).empty());
}

TEST(Episodes, WithoutTheScenesFactsFiguresThatNeedThemAreNone) {
    const auto found = episodes_of(
        200, [](int i, frame::Frame& frame) { frame.bodies[1].X_WB.p.z() = 0.1 * i; }, {});
    ASSERT_EQ(found.size(), 1u);
    EXPECT_TRUE(std::isnan(found[0].off_path));
    EXPECT_TRUE(std::isnan(found[0].release_ratio));
}

}  // namespace
}  // namespace dihaptic::analysis::episodes_test
