// Compares the effects of perturbations ordered by a director with closed-form solutions.
#include <gtest/gtest.h>

#include <numbers>

#include "frame/displayed.h"
#include "hand/script.h"
#include "rig/rig.h"
#include "servo/servo.h"
#include "testing/allocation_guard.h"

namespace dihaptic::servo::perturbation_test {
namespace {

constexpr double kMass = 0.2;
constexpr double kTick = 1e-3;

/// A finger far away from a block that floats or lies on a plane.
struct Desk {
    scene::Scene scene;
    std::unique_ptr<hand::ScriptDriver> driver;
    std::unique_ptr<Servo> servo;
    int next = 0;

    explicit Desk(bool gravity, double friction = 0.5, const Vec3& move = Vec3::Zero(),
                  const frame::Settings& settings = {}) {
        if (!gravity) scene.gravity.setZero();
        scene::Body plane;
        plane.name = "plane";
        plane.shape.kind = scene::ShapeKind::plane;
        plane.fixed = true;
        plane.friction = friction;
        if (!gravity) plane.position = {0, 0, -10};
        scene::Body block;
        block.name = "block";
        block.shape = scene::Shape::box({0.04, 0.04, 0.04});
        block.mass = kMass;
        block.friction = friction;
        block.position = {0, 0, 0.02};
        scene.bodies = {plane, block};
        scene::Finger finger;
        finger.name = "index";
        finger.shape = scene::Shape::sphere(0.005);
        scene.fingers = {finger};
        hand::HandSpec spec;
        spec.centre = {0.3, 0, 0.1};
        hand::ScriptStep step;
        step.name = "move";
        step.duration = 0.4;
        step.move = move;
        spec.script = {step};
        const std::vector<std::string> fingers{"index"};
        driver = std::make_unique<hand::ScriptDriver>(spec, fingers);
        const rig::Rig rig = rig::simulated_rig(fingers);
        devices::Context context;
        context.driver = driver.get();
        servo = std::make_unique<Servo>(scene, settings, rig::make_devices(rig, fingers, context),
                                        rig::poses(rig, fingers));
        servo->activate();
    }
    const frame::Frame& tick(
        const std::function<void(const frame::Frame&, frame::Commands&)>& order = {}) {
        return servo->tick(next++ * std::chrono::milliseconds(1),
                           [&](const frame::Frame& last, std::span<const frame::Handle>,
                               frame::Commands& commands) {
                               if (order) order(last, commands);
                           });
    }
};

frame::PropertiesFrame with_mass(const Vec3& scale) {
    frame::PropertiesFrame out;
    out.body = 1;
    out.mass_scale = scale;
    return out;
}

class AnySolver : public ::testing::TestWithParam<contact::Solver> {
  protected:
    frame::Settings settings() const {
        frame::Settings out;
        out.dynamics.solver = GetParam();
        return out;
    }
};
INSTANTIATE_TEST_SUITE_P(Perturbation, AnySolver,
                         ::testing::Values(contact::Solver::newton,
                                           contact::Solver::staggered_projections,
                                           contact::Solver::stewart_trinkle,
                                           contact::Solver::sequential_impulse),
                         [](const auto& of) { return std::string(enum_name(of.param)); });

TEST(Perturbation, DirectionalMassIsFeltAlongEachAxisAndTheWeightStays) {
    Desk desk(true);
    const Vec3 scale(3, 0.5, 2);
    const Vec3 force(0.3, -0.2, 0.4);
    Vec3 v = Vec3::Zero();
    // places the block in free fall, above the plane
    desk.tick([](const frame::Frame&, frame::Commands& c) {
        add(c.task.placements, {1, {Quat::Identity(), {0, 0, 1}}});
    });
    v = desk.servo->world().state({1}).v_WB;
    for (int i = 0; i < 100; ++i) {
        const frame::Frame& frame = desk.tick([&](const frame::Frame&, frame::Commands& c) {
            add(c.task.properties, with_mass(scale));
            add(c.task.loads, {1, force, Vec3::Zero()});
        });
        v += kTick * (force + kMass * desk.scene.gravity).cwiseQuotient(kMass * scale);
        EXPECT_LT((frame.bodies[1].v_WB - v).norm(), 1e-12);
        EXPECT_LT(frame.bodies[1].w_WB.norm(), 1e-12);
    }
    // without an order, the properties are those of the scene again
    const Vec3 before = desk.servo->world().state({1}).v_WB;
    const Vec3 after = desk.tick().bodies[1].v_WB;
    EXPECT_LT((after - before - kTick * desk.scene.gravity).norm(), 1e-12);
}

TEST(Perturbation, FrictionOfAFixedBodyWakesWhatRestsOnItAndLetsItSlide) {
    // a = (F - mu' m g) / m, where mu' uses half the plane's coefficient
    Desk desk(true, 0.5);
    for (int i = 0; i < 1000; ++i) desk.tick();
    EXPECT_EQ(desk.tick().bodies[1].awake, 0);
    const double force = 0.8;  // too little to overcome the full friction
    frame::PropertiesFrame slippery;
    slippery.body = 0;
    slippery.friction_scale = 0.5;
    double v = 0;
    for (int i = 0; i < 300; ++i) {
        const frame::Frame& frame = desk.tick([&](const frame::Frame&, frame::Commands& c) {
            add(c.task.properties, slippery);
            add(c.task.loads, {1, {force, 0, 0}, Vec3::Zero()});
        });
        if (i < 50) {
            v = frame.bodies[1].v_WB.x();
            continue;
        }
        v += kTick * (force - 0.25 * kMass * 9.81) / kMass;
        EXPECT_NEAR(frame.bodies[1].v_WB.x(), v, 2e-5) << i;
    }
    EXPECT_GT(v, 0.3);
    for (int i = 0; i < 1000; ++i) {  // without an order, the plane is as in the scene
        desk.tick([&](const frame::Frame&, frame::Commands& c) {
            add(c.task.loads, {1, {force, 0, 0}, Vec3::Zero()});
        });
    }
    EXPECT_NEAR(desk.servo->world().state({1}).v_WB.norm(), 0, 1e-6);
}

TEST_P(AnySolver, SlidesABlockOfDirectionalMassUnderItsTrueWeight) {
    // a = (F - mu m g) / (s m) along x; friction follows the weight, which is not scaled
    Desk desk(true, 0.5, Vec3::Zero(), settings());
    const double mu = 0.5;
    const double force = 2;
    double v = 0;
    for (int i = 0; i < 300; ++i) {
        const frame::Frame& frame = desk.tick([&](const frame::Frame&, frame::Commands& c) {
            add(c.task.properties, with_mass({3, 1, 1}));
            add(c.task.loads, {1, {force, 0, 0}, Vec3::Zero()});
        });
        if (i < 50) {
            v = frame.bodies[1].v_WB.x();
            continue;
        }
        v += kTick * (force - mu * kMass * 9.81) / (3 * kMass);
        EXPECT_NEAR(frame.bodies[1].v_WB.x(), v, 2e-5) << i;
        double normal = 0;
        for (const frame::ContactFrame& contact : frame.contacts) normal += contact.normal_force;
        EXPECT_NEAR(normal, kMass * 9.81, 2e-3);
    }
    EXPECT_GT(v, 0.4);
}

TEST(Perturbation, WeightDensityAndFrictionChangeWhatTheyName) {
    Desk desk(true);
    const auto normal_and_slide = [&](const frame::PropertiesFrame& properties, double force) {
        double normal = 0;
        for (int i = 0; i < 200; ++i) {
            const frame::Frame& frame = desk.tick([&](const frame::Frame&, frame::Commands& c) {
                if (i == 0) add(c.task.placements, {1, {Quat::Identity(), {0, 0, 0.02}}});
                add(c.task.properties, properties);
                add(c.task.loads, {1, {force, 0, 0}, Vec3::Zero()});
            });
            normal = 0;
            for (const frame::ContactFrame& contact : frame.contacts)
                normal += contact.normal_force;
        }
        return std::pair{normal, desk.servo->world().state({1}).v_WB.x()};
    };
    frame::PropertiesFrame heavy;
    heavy.body = 1;
    heavy.weight_scale = 2;
    const auto [weight, slid] = normal_and_slide(heavy, 3);
    EXPECT_NEAR(weight, 2 * kMass * 9.81, 1e-6);
    EXPECT_NEAR(slid, 0.2 * (3 - 0.5 * 2 * kMass * 9.81) / kMass, 1e-3);
    frame::PropertiesFrame dense = with_mass(Vec3::Constant(2));
    dense.weight_scale = dense.turning_scale = 2;
    const auto [dense_weight, dense_slid] = normal_and_slide(dense, 3);
    EXPECT_NEAR(dense_weight, 2 * kMass * 9.81, 1e-6);
    EXPECT_NEAR(dense_slid, 0.2 * (3 - 0.5 * 2 * kMass * 9.81) / (2 * kMass), 1e-3);
    frame::PropertiesFrame slippery;
    slippery.body = 1;
    slippery.friction_scale = 0.2;
    const auto [same_weight, slippery_slid] = normal_and_slide(slippery, 1);
    EXPECT_NEAR(same_weight, kMass * 9.81, 1e-6);
    EXPECT_NEAR(slippery_slid, 0.2 * (1 - 0.1 * kMass * 9.81) / kMass, 1e-3);
}

TEST(Perturbation, DensityScalesTheMomentsOfInertiaToo) {
    Desk desk(false);
    frame::PropertiesFrame dense = with_mass(Vec3::Constant(4));
    dense.turning_scale = 4;
    const double moment = kMass * (0.04 * 0.04 + 0.04 * 0.04) / 12;
    for (int i = 0; i < 10; ++i) {
        desk.tick([&](const frame::Frame&, frame::Commands& c) {
            add(c.task.properties, dense);
            add(c.task.loads, {1, Vec3::Zero(), {0, 0, 1e-3}});
        });
    }
    EXPECT_NEAR(desk.servo->world().state({1}).w_WB.z(), 10 * kTick * 1e-3 / (4 * moment), 1e-9);
}

TEST(Perturbation, AChangeOfWeightWakesWhatSleeps) {
    Desk desk(true);
    for (int i = 0; i < 700; ++i) desk.tick();
    ASSERT_EQ(desk.tick().bodies[1].awake, 0u);
    frame::PropertiesFrame floating;
    floating.body = 1;
    floating.weight_scale = -1;
    const auto order = [&](const frame::Frame&, frame::Commands& c) {
        add(c.task.properties, floating);
    };
    desk.tick(order);
    for (int i = 0; i < 99; ++i) desk.tick(order);
    EXPECT_NEAR(desk.servo->world().state({1}).v_WB.z(), 100 * kTick * 9.81, 1e-9);
}

TEST(Perturbation, AForceOnAHandleIsAddedToTheCouplingsAndLimitedAsThatIs) {
    frame::Settings settings;
    settings.safety.soft_start = 0;
    settings.safety.max_force = 2;
    Desk desk(true, 0.5, Vec3::Zero(), settings);
    const int32_t proxy = 2;
    const frame::Frame* frame = nullptr;
    for (int i = 0; i < 1000; ++i) {
        frame = &desk.tick([&](const frame::Frame&, frame::Commands& c) {
            add(c.task.loads, {proxy, {0, 0.6, 0}, Vec3::Zero()});
        });
    }
    EXPECT_LT((frame->fingers[0].f_sent_W - Vec3(0, 0.6, 0)).norm(), 1e-12);
    EXPECT_EQ(frame->fingers[0].f_asked_W, Vec3::Zero());
    EXPECT_NEAR(frame->fingers[0].p_WH.y(), 0.6 / 300, 1e-5);
    frame = &desk.tick([&](const frame::Frame&, frame::Commands& c) {
        add(c.task.loads, {proxy, {0, 60, 0}, Vec3::Zero()});
    });
    EXPECT_LE(frame->fingers[0].f_sent_W.norm(), 2 + 1e-12);
    EXPECT_NE(frame->status & (kForceLimited | kRateLimited), 0u);
}

TEST(Perturbation, TurnsScalesAndGuidesWhatIsShownAndNothingElse) {
    const Vec3 centre(0.3, 0, 0.1);
    const auto path = [&](const frame::VisualMap& map) -> Vec3 {
        Desk desk(true, 0.5, {0.1, 0, 0});
        double farthest = 0;
        for (int i = 0; i < 500; ++i) {
            const frame::Frame& frame = desk.tick(
                [&](const frame::Frame&, frame::Commands& c) { add(c.task.visual, map); });
            const Vec3 arm = frame.fingers[0].p_WH - centre;
            Vec3 expected = centre + map.R * map.scale.cwiseProduct(arm);
            if (map.along_W != Vec3::Zero()) expected = centre + arm.norm() * map.along_W;
            EXPECT_LT((displayed_handle(frame, 0).p - expected).norm(), 1e-15);
            EXPECT_EQ(displayed_body(frame, 1).p, frame.bodies[1].X_WB.p);
            farthest = std::max(farthest, arm.norm());
        }
        EXPECT_NEAR(farthest, 0.1, 0.002);
        return displayed_handle(desk.tick([&](const frame::Frame&, frame::Commands& c) {
                   add(c.task.visual, map);
               }),
                                0)
                   .p -
               centre;
    };
    frame::VisualMap map;
    map.moves = frame::kMovesProxies;
    map.p_WC = centre;
    map.R = Quat(Eigen::AngleAxisd(std::numbers::pi / 6, Vec3::UnitZ()));
    const Vec3 turned = path(map);
    EXPECT_NEAR(std::atan2(turned.y(), turned.x()), std::numbers::pi / 6, 1e-6);
    map.R = Quat::Identity();
    map.scale = {1.3, 1, 1};
    EXPECT_NEAR(path(map).x(), 0.13, 1e-4);
    map.along_W = Vec3(1, 1, 0).normalized();
    const Vec3 guided = path(map);
    EXPECT_NEAR(std::atan2(guided.y(), guided.x()), std::numbers::pi / 4, 1e-12);
}

TEST(Perturbation, MovesTheObjectAndItsSizeWhenItNamesThem) {
    Desk desk(true);
    frame::VisualMap map;
    map.moves = frame::kMovesObject | frame::kMovesTargets;
    map.object = 1;
    map.size = 1.2;
    map.p_WC = {0.1, 0, 0.02};
    map.R = Quat(Eigen::AngleAxisd(std::numbers::pi / 2, Vec3::UnitZ()));
    const frame::Frame& frame = desk.tick([&](const frame::Frame&, frame::Commands& c) {
        add(c.task.visual, map);
        add(c.task.targets, {0, {0.1, 0.1, 0}, 0.01});
    });
    EXPECT_LT((displayed_body(frame, 1).p - Vec3(0.1, -0.1, 0.02)).norm(), 1e-6);
    EXPECT_EQ(displayed_size(frame, 1), 1.2);
    EXPECT_EQ(displayed_size(frame, 0), 1);
    EXPECT_LT((displayed_target(frame, 0) - Vec3(0, 0, 0)).norm(), 1e-12);
    EXPECT_EQ(displayed_proxy(frame, 0).p, frame.fingers[0].p_WP);
}

TEST_P(AnySolver, SlidesABlockUnderScaledFriction) {
    Desk desk(true, 0.5, Vec3::Zero(), settings());
    for (int i = 0; i < 700; ++i) desk.tick();
    ASSERT_EQ(desk.tick().bodies[1].awake, 0u);
    // the block withstands 0.6 N with a friction scale of 0.7, but not with 0.2
    const auto pulled = [&](double scale) {
        return desk.tick([&](const frame::Frame&, frame::Commands& c) {
            c.knobs.friction_scale = scale;
            add(c.task.loads, {1, {0.6, 0, 0}, Vec3::Zero()});
        });
    };
    for (int i = 0; i < 100; ++i) ASSERT_NEAR(pulled(0.7).bodies[1].v_WB.x(), 0, 1e-5);
    double v = 0;
    for (int i = 0; i < 100; ++i) v = pulled(0.2).bodies[1].v_WB.x();
    EXPECT_NEAR(v, 0.1 * (0.6 - 0.1 * kMass * 9.81) / kMass, 2e-3);
    EXPECT_EQ(pulled(0.2).friction_scale, 0.2);
}

TEST(Perturbation, ScaledFrictionIsThatOfEveryProxy) {
    for (const bool point : {false, true}) {
        for (const auto friction : {frame::PointFriction::together, frame::PointFriction::apart}) {
            frame::Settings settings;
            if (point) settings.proxy.kind = scene::ProxyKind::point;
            settings.proxy.friction = friction;
            // the target moves down into the plane, then along it
            Desk desk(true, 0.5, {0.2, 0, -0.115}, settings);
            const double mu = scene::pair_friction(desk.scene, "plane", 0.5, "index",
                                                   desk.scene.fingers[0].friction);
            int slid = 0;
            for (int i = 0; i < 380; ++i) {
                const frame::Frame& frame = desk.tick(
                    [&](const frame::Frame&, frame::Commands& c) { c.knobs.friction_scale = 0.3; });
                const frame::FingerFrame& finger = frame.fingers[0];
                if (finger.normal_force < 0.3 || finger.v_WH.x() < 0.1) continue;
                ++slid;
                ASSERT_NEAR(-finger.f_contact_W.x() / finger.normal_force, 0.3 * mu, 2e-3) << i;
            }
            EXPECT_GT(slid, 20);
        }
    }
}

TEST(Perturbation, AllocatesNothing) {
    DIHAPTIC_NEEDS_ALLOCATION_GUARD();
    Desk desk(true);
    for (int i = 0; i < 700; ++i) desk.tick();
    const frame::Director director = [](const frame::Frame&, std::span<const frame::Handle>,
                                        frame::Commands& c) {
        add(c.task.visual, frame::VisualMap{});
        add(c.task.properties, with_mass({2, 1, 1}));
        for (int n = 0; n < 20; ++n) add(c.task.loads, {1, {0.1, 0, 0}, Vec3::Zero()});
        add(c.task.placements, {1, {Quat::Identity(), {0, 0, 0.02}}});
    };
    const testing::AllocationGuard guard;
    for (int i = 0; i < 50; ++i) {
        const frame::Frame& frame =
            desk.servo->tick(desk.next++ * std::chrono::milliseconds(1), director);
        ASSERT_EQ(frame.task.loads.size(), frame::TaskFrame::kMostLoads);
    }
    EXPECT_EQ(guard.count(), 0u);
}

}  // namespace
}  // namespace dihaptic::servo::perturbation_test
