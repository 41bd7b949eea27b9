// Tests textures, i.e. variations in friction and height along a surface.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "haptics/god_object.h"
#include "haptics/test/pressed.h"

namespace dihaptic::haptics::texture_test {
namespace {

using Proxy = PressedProxy;

constexpr double kFriction = 0.5;
constexpr double kWave = 0.01;
constexpr double kDeep = 0.003;

scene::Texture grating() {
    scene::Texture out;
    out.wavelength = kWave;
    out.friction = 0.4;
    return out;
}

/// The ratio of friction to normal force, by position, while a finger is drawn over a block at 20
/// mm/s.
std::vector<std::pair<Vec3, double>> drawn(Proxy proxy, const scene::Texture& texture,
                                           const Vec3& direction) {
    scene::Surface surface;
    surface.texture = texture;
    Pressed pressed(proxy, surface, kFriction);
    std::vector<std::pair<Vec3, double>> out;
    for (int i = 0; i < 3000; ++i) {
        const double t = i * kPressedTick;
        const Vec3 f = pressed.move(Vec3(0, 0, std::max(-kDeep, 0.002 - 0.05 * t)) +
                                    std::max(0.0, t - 0.2) * 0.02 * direction);
        if (t > 0.8 && f.z() > 0.5) out.emplace_back(pressed.proxy(), f.head<2>().norm() / f.z());
    }
    return out;
}

class Textured : public ::testing::TestWithParam<Proxy> {};
INSTANTIATE_TEST_SUITE_P(Haptics, Textured,
                         ::testing::Values(Proxy::rigid, Proxy::point_apart, Proxy::point_solved),
                         name_of_proxy);

TEST_P(Textured, GratingsAreFeltAcrossTheirRidges) {
    const auto felt = drawn(GetParam(), grating(), Vec3::UnitX());
    ASSERT_GT(felt.size(), 2000u);
    for (const auto& [p, ratio] : felt) {
        const double expected =
            kFriction * (1 + 0.4 * std::cos(2 * std::numbers::pi * p.x() / kWave));
        ASSERT_NEAR(ratio, expected, 0.03) << p.transpose();
    }
}

TEST_P(Textured, AndNotAlongThem) {
    for (const auto& [p, ratio] : drawn(GetParam(), grating(), Vec3::UnitY()))
        ASSERT_NEAR(ratio, 1.4 * kFriction, 0.01) << p.transpose();
}

TEST_P(Textured, GridsHaveBumps) {
    scene::Texture grid = grating();
    grid.kind = scene::TextureKind::grid;
    const auto wave = [](double way) { return std::cos(2 * std::numbers::pi * way / kWave); };
    for (const auto& [p, ratio] : drawn(GetParam(), grid, Vec3(1, 0.3, 0).normalized())) {
        const double bumps = (1 + wave(p.x())) * (1 + wave(p.y())) / 2 - 1;
        ASSERT_NEAR(ratio, kFriction * (1 + 0.4 * bumps), 0.03) << p.transpose();
    }
}

class High : public ::testing::TestWithParam<Proxy> {};
INSTANTIATE_TEST_SUITE_P(Haptics, High, ::testing::Values(Proxy::rigid, Proxy::point_solved),
                         name_of_proxy);

scene::Texture smooth_ridges(double height) {
    scene::Texture out = grating();
    out.friction = 0;
    out.height = height;
    return out;
}

scene::Surface surface_with(const scene::Texture& texture) {
    scene::Surface out;
    out.texture = texture;
    return out;
}

/// Frictionless ridges 0.2 mm high: the proxy rides on them, and the force is perpendicular to
/// their slope.
TEST_P(High, RidgesLiftAndPushBackAsTheirSlopeSays) {
    scene::Texture ridges = smooth_ridges(2e-4);
    Pressed pressed(GetParam(), surface_with(ridges), 0);
    const bool is_point = GetParam() == Proxy::point_solved;
    const double floor = is_point ? kSkin : 0.008;
    const double deep = kDeep + (is_point ? kSkin : 0);
    double most = 0, lowest = 1, highest = -1;
    for (int i = 0; i < 3000; ++i) {
        const double t = i * kPressedTick;
        const Vec3 f =
            pressed.move({std::max(0.0, t - 0.2) * 0.01, 0, std::max(-kDeep, 0.002 - 0.05 * t)});
        if (t < 0.8) continue;
        const Vec3 p = pressed.proxy();
        const scene::Relief relief = ridges.at(p, Vec3::UnitZ());
        ASSERT_NEAR(p.z() - floor, relief.height, 4e-6) << p.transpose();
        ASSERT_NEAR(-f.x() / f.z(), relief.slope.x(), 0.004) << p.transpose();
        ASSERT_NEAR(f.z(), kPressedCoupling * (deep + relief.height), 0.01) << p.transpose();
        most = std::max(most, std::abs(f.x()) / f.z());
        lowest = std::min(lowest, p.z() - floor);
        highest = std::max(highest, p.z() - floor);
    }
    EXPECT_NEAR(most, ridges.steepest(), 0.004);
    EXPECT_NEAR(lowest, 0, 1e-6);
    EXPECT_NEAR(highest, ridges.height, 1e-6);
}

TEST_P(High, RidgesAreScaledByTheBodysProperties) {
    scene::Texture ridges = smooth_ridges(1e-4);
    Pressed pressed(GetParam(), surface_with(ridges), 0);
    dynamics::BodyProperties properties;
    properties.texture_wavelength = 1.25;
    properties.texture_height = 2;
    pressed.set_properties(properties);
    ridges.wavelength *= 1.25;
    ridges.height *= 2;
    const double floor = GetParam() == Proxy::point_solved ? kSkin : 0.008;
    const auto follow = [&](const scene::Texture& texture, double from) {
        double highest = 0;
        for (int i = 0; i < 1500; ++i) {
            pressed.move({from + i * kPressedTick * 0.01, 0, -kDeep});
            if (i < 500) continue;
            const Vec3 p = pressed.proxy();
            EXPECT_NEAR(p.z() - floor, texture.at(p, Vec3::UnitZ()).height, 4e-6) << p.transpose();
            highest = std::max(highest, p.z() - floor);
        }
        EXPECT_NEAR(highest, texture.height, 1e-5);
    };
    follow(ridges, 0);
    pressed.set_properties({});
    ridges.wavelength /= 1.25;
    ridges.height /= 2;
    follow(ridges, 0.015);
}

TEST(Texture, RisesAsItsSlopeSays) {
    for (const auto kind : {scene::TextureKind::grating, scene::TextureKind::grid}) {
        scene::Texture texture = grating();
        texture.kind = kind;
        texture.height = 3e-4;
        texture.along = {1, 1, 0};
        for (const Vec3& n : {Vec3(0, 0, 1), Vec3(0, -1, 0)}) {
            for (const Vec3& p : {Vec3(0.003, 0.001, 0.002), Vec3(-0.001, 0.0042, 0.007)}) {
                const Vec3 slope = texture.at(p, n).slope;
                EXPECT_NEAR(slope.dot(n), 0, 1e-15);
                for (int i = 0; i < 3; ++i) {
                    const Vec3 d = 1e-6 * Vec3::Unit(i);
                    if (n.cwiseAbs()[i] > 0) continue;
                    const double rise =
                        (texture.at(p + d, n).height - texture.at(p - d, n).height) / 2e-6;
                    EXPECT_NEAR(slope[i], rise, 1e-6);
                }
                EXPECT_LE(slope.norm(), std::numbers::sqrt2 * texture.steepest());
            }
        }
    }
}

TEST(Texture, TurnsWithItsBody) {
    scene::Texture texture = grating();
    texture.along = {0, 2, 0};
    EXPECT_NEAR(texture.at({0.3, kWave / 2, 0}, Vec3::UnitZ()).friction, 0.6, 1e-12);
    EXPECT_NEAR(texture.at({0.3, kWave, 0}, Vec3::UnitZ()).friction, 1.4, 1e-12);
    scene::Scene scene;
    scene::Body block;
    block.name = "block";
    block.shape = scene::Shape::box({0.1, 0.1, 0.1});
    block.rotation = {0, 0, std::numbers::pi / 2};
    block.position = {1, 2, 3};
    block.mass = 0.1;
    block.friction = kFriction;
    block.surface.texture = grating();
    scene::Body other = block;
    other.name = "other";
    other.surface.texture.reset();
    scene.bodies = {block, other};
    World world(scene, frame::DynamicsSettings{});
    world.activate();
    // the texture's x is the world's y
    EXPECT_NEAR(world.friction_at({0}, {1}, {1.4, 2 + kWave / 2, 3.05}, Vec3::UnitZ()),
                0.6 * kFriction, 1e-9);
    EXPECT_NEAR(world.friction_at({1}, {0}, {1.4, 2, 3.05}, Vec3::UnitZ()), 1.4 * kFriction, 1e-9);
    EXPECT_EQ(world.friction({0}, {1}), kFriction);
}

}  // namespace
}  // namespace dihaptic::haptics::texture_test
