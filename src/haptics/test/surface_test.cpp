// Tests where straight paths enter a cone, compared with a search along the paths.
#include "haptics/surface.h"

#include <gtest/gtest.h>

#include <numbers>

#include "haptics/test/shapes.h"

namespace dihaptic::haptics::surface_test {
namespace {

/// The s for which p + s d is deepest in a convex shape, found by ternary search.
double deepest(const scene::Shape& shape, const Vec3& p, const Vec3& d) {
    double low = 0, high = 1;
    for (int i = 0; i < 120; ++i) {
        const double a = low + (high - low) / 3, b = high - (high - low) / 3;
        if (scene::depth(shape, p + a * d) < scene::depth(shape, p + b * d)) {
            low = a;
        } else {
            high = b;
        }
    }
    return (low + high) / 2;
}

/// The first s for which p + s d is in the shape, found between an s outside and an s inside.
double entry(const scene::Shape& shape, const Vec3& p, const Vec3& d, double inside) {
    double low = 0, high = inside;
    for (int i = 0; i < 60; ++i) {
        const double middle = (low + high) / 2;
        (scene::depth(shape, p + middle * d) < 0 ? low : high) = middle;
    }
    return high;
}

void expect_enters(const scene::Shape& shape, const Vec3& p, const Vec3& d, int& entered) {
    constexpr double kClear = 1e-6;
    const Surface surface(shape, 0);
    if (scene::depth(shape, p) > -kClear) return;
    EXPECT_NEAR(surface.separation(p), -scene::depth(shape, p), 1e-15);
    const double at = deepest(shape, p, d);
    const double depth = scene::depth(shape, p + at * d);
    const auto found = surface.enter(p, d);
    if (depth < -kClear) {
        EXPECT_FALSE(found) << depth;
    } else if (depth > kClear) {
        ++entered;
        ASSERT_TRUE(found) << depth;
        EXPECT_NEAR(found->share * d.norm(), entry(shape, p, d, at) * d.norm(), 1e-9);
        EXPECT_NEAR(surface.distance(found->face, p + found->share * d), 0, 1e-12);
    }
}

TEST(Surface, PathsEnterConesWhereTheyMeetThem) {
    Random random(3, "paths");
    int entered = 0;
    for (const auto& [radius, height] : {std::pair{0.02, 0.03}, {0.002, 0.06}, {0.03, 0.003}}) {
        const scene::Shape cone = round(scene::ShapeKind::cone, radius, height);
        const double size = std::max(radius, height / 2);
        for (int i = 0; i < 5000; ++i) {
            const Vec3 to = 0.6 * size * random_vector(random);
            const Vec3 from = 2 * size * random_vector(random).normalized();
            expect_enters(cone, from, random.uniform(0.3, 2) * (to - from), entered);
            // parallel to a line of the cone's side, and nearly parallel to it
            const double angle = random.uniform(0, 2 * std::numbers::pi);
            const Vec3 line(radius * std::cos(angle), radius * std::sin(angle), -height);
            const Vec3 beside = i % 2 == 0 ? Vec3(line) : Vec3(line + 1e-9 * to);
            expect_enters(cone, from, random.uniform(0, 1) < 0.5 ? beside : Vec3(-beside), entered);
        }
    }
    EXPECT_GT(entered, 3000);
}

}  // namespace
}  // namespace dihaptic::haptics::surface_test
