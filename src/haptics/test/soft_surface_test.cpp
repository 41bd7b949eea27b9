// Tests how soft surfaces feel to each kind of proxy: as a spring in series with the coupling, and
// with the friction that goes with what is felt.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <memory>
#include <string>

#include "haptics/finger.h"

namespace dihaptic::haptics::soft_surface_test {
namespace {

constexpr double kTick = 1e-3;
constexpr double kCoupling = 1000;  // [N/m]

enum class Proxy { rigid, point_apart, point_solved };

/// A finger above a fixed block whose top is at z = 0.
class Pressed {
  public:
    Pressed(Proxy proxy, const scene::Surface& surface, double friction, int every = 1)
        : every_(every) {
        scene::Body block;
        block.name = "block";
        block.shape = scene::Shape::box({0.4, 0.4, 0.4});
        block.position = {0, 0, -0.2};
        block.fixed = true;
        block.friction = friction;
        block.surface = surface;
        scene::Finger spec;
        spec.name = "index";
        spec.shape = scene::Shape::sphere(kRadius);
        spec.friction = friction;
        scene_.bodies = {block};
        scene_.fingers = {spec};
        world_ = std::make_unique<World>(scene_, dynamics::Settings{});
        CouplingSettings coupling;
        coupling.stiffness = kCoupling;
        lift_ = proxy == Proxy::rigid ? kRadius : 0;
        const Vec3 at(0, 0, lift_ + 0.002);
        if (proxy == Proxy::rigid) {
            body_ = world_->add_proxy(spec, at);
            finger_ = std::make_unique<Finger>(spec, body_, coupling, 50);
        } else {
            body_ = world_->add_point(spec, at);
            finger_ = proxy == Proxy::point_apart
                          ? std::make_unique<Finger>(
                                PointProxy(scene_, body_, coupling, ProxySettings{}), body_)
                          : std::make_unique<Finger>(
                                SolvedPoint(scene_, body_, coupling, ProxySettings{}), body_);
        }
        world_->activate();
        handle_ = {at, Vec3::Zero()};
        finger_->place(*world_, handle_);
    }

    /// Moves the handle there at 50 mm/s, waits, and returns the force that it feels.
    Vec3 go(const Vec3& p, int wait = 500) {
        const Vec3 to = p + Vec3(0, 0, lift_);
        const Vec3 from = handle_.p_WH;
        const int ticks = std::max(1, static_cast<int>((to - from).norm() / (0.05 * kTick)));
        Vec3 f = Vec3::Zero();
        for (int i = 1; i <= ticks + wait; ++i)
            f = tick(from + std::min(1.0, double(i) / ticks) * (to - from));
        return f;
    }
    const Finger& finger() const { return *finger_; }

  private:
    static constexpr double kRadius = 0.008;

    Vec3 tick(const Vec3& p) {
        handle_.v_WH = (p - handle_.p_WH) / kTick;
        handle_.p_WH = p;
        const double step = kTick * every_;
        finger_->begin_tick(*world_, handle_, step);
        if (ticks_++ % every_ == 0) {
            finger_->before_step(*world_, handle_, step);
            world_->step(step);
            finger_->after_step(*world_, handle_);
        }
        return finger_->force(*world_, handle_, kTick);
    }

    scene::Scene scene_;
    std::unique_ptr<World> world_;
    std::unique_ptr<Finger> finger_;
    BodyIndex body_;
    Handle handle_;
    double lift_ = 0;  // of the handle over what touches the block [m]
    int every_;
    int ticks_ = 0;
};

std::string name_of(const ::testing::TestParamInfo<Proxy>& which) {
    constexpr std::array kNames{"rigid", "point_apart", "point_solved"};
    return kNames[static_cast<size_t>(which.param)];
}

class SoftSurface : public ::testing::TestWithParam<Proxy> {};
INSTANTIATE_TEST_SUITE_P(Haptics, SoftSurface,
                         ::testing::Values(Proxy::rigid, Proxy::point_apart, Proxy::point_solved),
                         name_of);

scene::Surface soft(double k) {
    scene::Surface out;
    out.stiffness = k;
    return out;
}

double in_series(double k) {
    return k * kCoupling / (k + kCoupling);
}

TEST_P(SoftSurface, IsFeltInSeriesWithTheCoupling) {
    for (const double k : {50.0, 300.0, 1000.0, 5000.0}) {
        for (const int every : {1, 5}) {
            Pressed pressed(GetParam(), soft(k), 0.8, every);
            for (const double depth : {0.005, 0.012, 0.003}) {
                const Vec3 f = pressed.go({0, 0, -depth});
                EXPECT_NEAR(f.z() / (in_series(k) * depth), 1, 0.005) << k << " " << depth;
                EXPECT_LT(f.head<2>().norm(), 1e-6);
            }
            EXPECT_EQ(pressed.go({0, 0, 0.001}), Vec3::Zero());
        }
    }
}

TEST_P(SoftSurface, HasTheFrictionOfWhatIsFelt) {
    constexpr double k = 400, kFriction = 0.5, kDepth = 0.01;
    Pressed pressed(GetParam(), soft(k), kFriction);
    const double normal = in_series(k) * kDepth;
    pressed.go({0, 0, -kDepth});
    // it holds as a spring, up to the cone
    const Vec3 held = pressed.go({0.0005, 0, -kDepth});
    EXPECT_NEAR(held.x(), -kCoupling * 0.0005, 0.02 * kCoupling * 0.0005);
    const Vec3 slid = pressed.go({0.02, 0, -kDepth}, 0);
    EXPECT_NEAR(slid.z(), normal, 0.02 * normal);
    EXPECT_NEAR(slid.x(), -kFriction * slid.z(), 0.02 * normal);
}

TEST_P(SoftSurface, HoldsTheEnergyOfItsSpring) {
    constexpr double k = 400, kDepth = 0.01;
    Pressed pressed(GetParam(), soft(k), 0.5);
    pressed.go({0, 0, -kDepth});
    // a body's own spring is in the world; a point's surface is in the coupling
    const double coupling = GetParam() == Proxy::rigid
                                ? kCoupling / 2 * std::pow(kDepth * k / (k + kCoupling), 2)
                                : in_series(k) / 2 * kDepth * kDepth;
    EXPECT_NEAR(pressed.finger().stored(), coupling, 0.01 * coupling);
}

TEST_P(SoftSurface, ThatIsHardFeelsRigid) {
    Pressed hard(GetParam(), soft(1e6), 0.5);
    Pressed rigid(GetParam(), {}, 0.5);
    for (const double depth : {0.001, 0.008, 0.0}) {
        const double f = hard.go({0, 0, -depth}).z();
        EXPECT_NEAR(f, rigid.go({0, 0, -depth}).z(), 0.002 * f + 1e-9);
    }
}

}  // namespace
}  // namespace dihaptic::haptics::soft_surface_test
