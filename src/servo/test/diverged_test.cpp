// Tests that force is zero on all fingers in any tick in which some part of the loop computes with
// a value that is not a number, and that the reason is reported.
#include <gtest/gtest.h>

#include <limits>

#include "planted.h"
#include "testing/allocation_guard.h"

namespace dihaptic::servo::diverged_test {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
const Vec3 kEast = Vec3::UnitX();

/// A change made on purpose in one tick of a grasp.
struct Planted {
    const char* name;
    haptics::FaultKind kind;  ///< `none`: any fault, or no fault if there is no effect
    std::function<void(PlantedGrasp&, double)> change;    ///< made before the tick
    std::function<void(frame::Commands&, double)> order;  ///< ordered by the director in the tick
};

void read(PlantedGrasp& grasp, const std::function<void(devices::Reading&)>& change) {
    grasp.devices->plant = [change](std::span<devices::Reading> readings) { change(readings[1]); };
}

frame::LoadFrame load(int32_t body, const Vec3& force) {
    frame::LoadFrame out;
    out.body = body;
    out.force_W = force;
    return out;
}

constexpr int kTable = 0, kBlock = 1, kProxy = 2;

const std::vector<Planted> kPlanted{
    {"position",
     haptics::FaultKind::bad_reading,
     [](PlantedGrasp& g, double x) { read(g, [x](auto& r) { r.p_DH.y() = x; }); },
     {}},
    {"velocity",
     haptics::FaultKind::bad_reading,
     [](PlantedGrasp& g, double x) { read(g, [x](auto& r) { r.v_DH.z() = x; }); },
     {}},
    {"field",
     haptics::FaultKind::not_finite,
     {},
     [](frame::Commands& c, double x) { c.task.loads.push_back(load(kProxy, x * kEast)); }},
    {"load_on_a_body",
     haptics::FaultKind::diverged,
     {},
     [](frame::Commands& c, double x) { c.task.loads.push_back(load(kBlock, x * kEast)); }},
    {"torque_on_a_body",
     haptics::FaultKind::diverged,
     {},
     [](frame::Commands& c, double x) {
         c.task.loads.push_back(load(kBlock, Vec3::Zero()));
         c.task.loads.back().torque_W.z() = x;
     }},
    {"place_of_a_body",
     haptics::FaultKind::diverged,
     {},
     [](frame::Commands& c, double x) {
         c.task.placements.push_back({kBlock, {Quat::Identity(), x * kEast}});
     }},
    {"turn_of_a_body",
     haptics::FaultKind::diverged,
     {},
     [](frame::Commands& c, double x) {
         c.task.placements.push_back({kBlock, {{1, x, 0, 0}, kEast}});
     }},
    {"place_of_a_fixed_body",
     haptics::FaultKind::diverged,
     {},
     [](frame::Commands& c, double) {
         c.task.placements.push_back({kTable, {Quat::Identity(), Vec3::Constant(kUnmeasured)}});
     }},
    {"velocity_of_a_body",
     haptics::FaultKind::diverged,
     [](PlantedGrasp& g, double x) { g.servo->world().set_velocity({kBlock}, x * kEast); },
     {}},
    {"mass_of_a_body",
     haptics::FaultKind::none,
     {},
     [](frame::Commands& c, double x) {
         frame::PropertiesFrame properties;
         properties.body = kBlock;
         properties.mass_scale = Vec3::Constant(x);
         properties.weight_scale = x;
         c.task.properties.push_back(properties);
     }},
    {"friction",
     haptics::FaultKind::none,
     {},
     [](frame::Commands& c, double x) { c.knobs.friction_scale = x; }},
    {"stiffness",
     haptics::FaultKind::none,
     {},
     [](frame::Commands& c, double x) { c.knobs.stiffness = x; }},
    {"damping",
     haptics::FaultKind::none,
     {},
     [](frame::Commands& c, double x) { c.knobs.damping = x; }},
    {"clock_that_goes_back",
     haptics::FaultKind::late,
     [](PlantedGrasp& g, double) { g.now -= std::chrono::milliseconds(5); },
     {}},
    {"clock_that_jumps",
     haptics::FaultKind::late,
     [](PlantedGrasp& g, double) { g.now += std::chrono::seconds(5); },
     {}},
};

struct Setting {
    const char* name;
    scene::ProxyKind proxy;
    frame::CouplingKind coupling;
    contact::Solver solver;
    frame::PointFriction friction = frame::PointFriction::together;
};
const std::vector<Setting> kSettings{
    {"newton", scene::ProxyKind::rigid, frame::CouplingKind::implicit, contact::Solver::newton},
    {"stewart_trinkle", scene::ProxyKind::rigid, frame::CouplingKind::velocity_impulse,
     contact::Solver::stewart_trinkle},
    {"staggered", scene::ProxyKind::rigid, frame::CouplingKind::dual_spring,
     contact::Solver::staggered_projections},
    {"bullet", scene::ProxyKind::rigid, frame::CouplingKind::implicit,
     contact::Solver::sequential_impulse},
    {"point", scene::ProxyKind::point, frame::CouplingKind::implicit, contact::Solver::newton},
    {"point_apart", scene::ProxyKind::point, frame::CouplingKind::implicit, contact::Solver::newton,
     frame::PointFriction::apart},
};

frame::Settings settings_of(const Setting& setting) {
    frame::Settings out;
    out.proxy.kind = setting.proxy;
    out.proxy.friction = setting.friction;
    out.coupling.kind = setting.coupling;
    out.dynamics.solver = setting.solver;
    return out;
}

class NoNumber : public ::testing::TestWithParam<std::tuple<size_t, double>> {};

TEST_P(NoNumber, EndsForceInTheSameTick) {
    DIHAPTIC_NEEDS_ALLOCATION_GUARD();
    const Planted& planted = kPlanted[std::get<0>(GetParam())];
    const double x = std::get<1>(GetParam());
    for (const Setting& setting : kSettings) {
        SCOPED_TRACE(setting.name);
        PlantedGrasp grasp(settings_of(setting));
        grasp.grasp();
        ASSERT_GT(grasp.told(), 0.5);
        ASSERT_FALSE(grasp.servo->fault());
        if (planted.change) planted.change(grasp, x);
        const frame::Director director = [&](const frame::Frame&, std::span<const frame::Handle>,
                                             frame::Commands& commands) {
            if (planted.order) planted.order(commands, x);
        };
        const frame::Director nothing;
        const testing::AllocationGuard guard;
        for (int i = 0; i < 100; ++i) {
            const frame::Frame& frame = grasp.tick(i == 0 ? director : nothing);
            const haptics::Fault& fault = grasp.servo->fault();
            if (!fault && planted.kind == haptics::FaultKind::none) {
                ASSERT_TRUE(std::isfinite(grasp.told())) << i;
                ASSERT_LE(grasp.told(), 8.5 + 1e-9) << i;
                continue;
            }
            ASSERT_TRUE(fault) << i;
            ASSERT_EQ(grasp.devices->told[0].force, Vec3::Zero()) << i;
            ASSERT_EQ(grasp.devices->told[1].force, Vec3::Zero()) << i;
            ASSERT_NE(frame.status & kForceOff, 0u) << i;
            for (const frame::ContactFrame& contact : frame.contacts) {
                ASSERT_GE(contact.a, 0);
                ASSERT_LT(contact.b, 4);
            }
        }
        EXPECT_EQ(guard.count(), 0u);
        if (planted.kind != haptics::FaultKind::none) {
            EXPECT_EQ(grasp.servo->fault().kind, planted.kind);
        }
    }
}

TEST(NoNumber, OfACalibrationIsABadReading) {
    PlantedGrasp grasp({}, [](std::vector<Pose>& poses) { poses[1].p.x() = kUnmeasured; });
    const frame::Frame& frame = grasp.tick();
    EXPECT_EQ(grasp.servo->fault().kind, haptics::FaultKind::bad_reading);
    EXPECT_EQ(grasp.servo->fault().device, 1);
    EXPECT_EQ(grasp.told(), 0);
    EXPECT_NE(frame.status & kForceOff, 0u);
}

INSTANTIATE_TEST_SUITE_P(Servo, NoNumber,
                         ::testing::Combine(::testing::Range(size_t{0}, kPlanted.size()),
                                            ::testing::Values(kUnmeasured, kInfinity)),
                         [](const auto& which) {
                             return std::string(kPlanted[std::get<0>(which.param)].name) +
                                    (std::isnan(std::get<1>(which.param)) ? "_nan" : "_infinite");
                         });

TEST(HugeNumbers, DivergeBeforeTheyOverflow) {
    for (const Setting& setting : kSettings) {
        SCOPED_TRACE(setting.name);
        for (const double x : {1e13, 1e100, -1e300}) {
            PlantedGrasp grasp(settings_of(setting));
            grasp.grasp();
            grasp.servo->world().set_velocity({kBlock}, x * kEast);
            grasp.tick();
            EXPECT_EQ(grasp.servo->fault().kind, haptics::FaultKind::diverged) << x;
            EXPECT_EQ(grasp.told(), 0);
        }
        // values that are absurd but finite are accepted
        PlantedGrasp grasp(settings_of(setting));
        grasp.grasp();
        grasp.servo->world().set_velocity({kBlock}, 1e8 * kEast);
        for (int i = 0; i < 100; ++i) ASSERT_TRUE(std::isfinite(grasp.tick().fingers[0].p_WP.x()));
    }
}

TEST(ADivergedWorld, IsMendedWhenTheSessionGoesOn) {
    for (const Setting& setting : kSettings) {
        SCOPED_TRACE(setting.name);
        PlantedGrasp grasp(settings_of(setting));
        grasp.grasp();
        grasp.tick(
            [](const frame::Frame&, std::span<const frame::Handle>, frame::Commands& commands) {
                commands.task.loads.push_back(load(kBlock, kUnmeasured * kEast));
            });
        ASSERT_EQ(grasp.servo->fault().kind, haptics::FaultKind::diverged);
        ASSERT_TRUE(grasp.servo->world().diverged());
        grasp.servo->rest();
        grasp.servo->resume();
        for (int i = 0; i < 1000; ++i) {
            const frame::Frame& frame = grasp.tick();
            ASSERT_EQ(frame.status & (kForceOff | kNotFinite), 0u) << i;
            ASSERT_TRUE(frame.bodies[kBlock].X_WB.p.allFinite());
            if (i == 0) {
                ASSERT_EQ(grasp.told(), 0);
            }
        }
    }
}

}  // namespace
}  // namespace dihaptic::servo::diverged_test
