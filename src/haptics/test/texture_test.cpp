// Tests textures: friction that is felt to rise and fall along a surface, by each kind of proxy.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <vector>

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

/// Friction over normal force while a finger is drawn over a block at 20 mm/s, by where it is.
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

TEST(Texture, TurnsWithItsBody) {
    scene::Texture texture = grating();
    texture.along = {0, 2, 0};
    EXPECT_NEAR(texture.factor({0.3, kWave / 2, 0}, Vec3::UnitZ()), 0.6, 1e-12);
    EXPECT_NEAR(texture.factor({0.3, kWave, 0}, Vec3::UnitZ()), 1.4, 1e-12);
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
    World world(scene, dynamics::Settings{});
    world.activate();
    // its x is the world's y
    EXPECT_NEAR(world.friction_at({0}, {1}, {1.4, 2 + kWave / 2, 3.05}, Vec3::UnitZ()),
                0.6 * kFriction, 1e-9);
    EXPECT_NEAR(world.friction_at({1}, {0}, {1.4, 2, 3.05}, Vec3::UnitZ()), 1.4 * kFriction, 1e-9);
    EXPECT_EQ(world.friction({0}, {1}), kFriction);
}

}  // namespace
}  // namespace dihaptic::haptics::texture_test
