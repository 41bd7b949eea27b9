// Tests a rig with a scaled workspace: how a wall in the scene feels to the hand, and where it is
// in the world.
#include <gtest/gtest.h>

#include "lift.h"
#include "servo/servo.h"
#include "testing/allocation_guard.h"

namespace dihaptic::servo::scaled_test {
namespace {

constexpr double kStiffness = 800;  // stiffness of the coupling, and therefore of the wall [N/m]

/// A finger that presses on a table because its target is below the table's surface.
class PressDriver final : public hand::Driver {
  public:
    explicit PressDriver(double depth) : depth_(depth) {}
    double duration() const override { return 1; }
    const std::vector<Phase>& phases() const override { return phases_; }

  private:
    hand::FingerTarget do_target(int, double t) const noexcept override {
        // approaches slowly, from above
        const double z = 0.02 - (0.02 + depth_) * std::min(1.0, t);
        return {{0.01, 0.02, z}, {0, 0, t < 1 ? -(0.02 + depth_) : 0}};
    }
    double depth_;
    std::vector<Phase> phases_;
};

/// The hand's position at rest, and the force on it there.
struct Rest {
    double world_depth = 0;  // depth of the handle below the proxy, in the world [m]
    double world_force = 0;  // [N]
    double hand_depth = 0;   // depth in terms of the hand's own movement [m]
    double hand_force = 0;   // force of the hand's spring [N]
    uint32_t status = 0;
};

Rest press(double scale, const frame::Settings& given = {}) {
    frame::Settings settings = given;
    settings.coupling.stiffness = kStiffness;
    scene::Scene scene = block_on_table();
    scene.bodies.resize(1);  // the table
    scene.fingers.resize(1);
    const std::string finger = scene.fingers[0].name;
    rig::Rig rig = rig::simulated_rig({finger});
    rig.devices[0].scale = scale;
    rig.devices[0].position = {0.05, -0.1, 0.15};
    rig.devices[0].rotation = {0.5, 0.2, 1.1};
    // positions in the world, where the hand's movement is scaled; the finger touches at z = 10 mm
    const PressDriver driver(0.02 * scale - 0.01);
    devices::Context context;
    context.driver = &driver;
    context.tick = settings.tick();
    Servo servo(scene, settings, rig::make_devices(rig, {finger}, context),
                rig::poses(rig, {finger}));
    servo.activate();
    const frame::Frame* frame = nullptr;
    uint32_t status = 0;
    for (int i = 0; i < 3000; ++i) {
        frame = &servo.tick(i * std::chrono::milliseconds(1), {});
        status |= frame->status;
    }
    const frame::FingerFrame& f = frame->fingers[0];
    Rest out;
    out.status = status;
    out.world_force = f.f_sent_W.z();
    out.world_depth = f.p_WP.z() - f.p_WH.z();
    // the hand's own positions: the readings are s times as far from the origin of D
    const Vec3 origin = rig.devices[0].position;
    const Vec3 hand = origin + (f.p_WH - origin) / scale;
    const Vec3 surface = origin + (f.p_WP - origin) / scale;
    const Vec3 target = origin + (driver.target(0, 3).p_WT - origin) / scale;
    out.hand_depth = surface.z() - hand.z();
    out.hand_force = context.impedance.stiffness * (hand - target).z();
    return out;
}

TEST(ScaledRig, WallIsAsStiffUnderTheHandAndInTheWorldAsTheSceneSays) {
    const Rest plain = press(1);
    for (const double scale : {3.0, 0.5}) {
        const Rest rest = press(scale);
        EXPECT_GT(rest.hand_depth, 2e-3);
        EXPECT_NEAR(rest.world_force / rest.world_depth, kStiffness, 0.01 * kStiffness) << scale;
        EXPECT_NEAR(rest.hand_force / rest.hand_depth, kStiffness, 0.01 * kStiffness) << scale;
        // the hand feels the world's force divided by the scale
        EXPECT_NEAR(rest.hand_force * scale / rest.world_force, 1, 0.01);
        // the person cannot feel that there is a scale
        EXPECT_NEAR(rest.hand_force / plain.hand_force, 1, 0.01);
        EXPECT_NEAR(rest.hand_depth / plain.hand_depth, 1, 0.01);
        EXPECT_EQ(rest.status & (kEnergyGenerated | kForceLimited | kTooFast), 0U);
    }
}

TEST(ScaledRig, LimitsAreThoseOfTheHandsForce) {
    frame::Settings settings;
    settings.safety.max_force = 1;
    for (const double scale : {3.0, 0.5}) {
        const Rest rest = press(scale, settings);
        EXPECT_NEAR(rest.hand_force, 1, 0.01) << scale;
        EXPECT_NE(rest.status & kForceLimited, 0U);
    }
}

}  // namespace
}  // namespace dihaptic::servo::scaled_test
