#include "view/colours.h"

#include <array>
#include <cmath>

#include "base/palette.h"
#include "scene/colour.h"

namespace dihaptic::view {
namespace {

constexpr std::array kBodies{"#0072b2", "#56b4e9", "#d55e00", "#f0e442"};
constexpr const char* kFixed = "#c4c1b9";

}  // namespace

Vec3 linear_colour(const std::string& hex) {
    return linear_colour(static_cast<uint32_t>(scene::colour_of(hex).value_or(0x999999)));
}

Vec3 linear_colour(uint32_t rgb) {
    Vec3 out;
    for (int i = 0; i < 3; ++i) {
        const double s = (rgb >> (16 - 8 * i) & 0xff) / 255.0;
        out[i] = s <= 0.04045 ? s / 12.92 : std::pow((s + 0.055) / 1.055, 2.4);  // IEC 61966-2-1
    }
    return out;
}

Vec3 body_colour(const scene::Scene& scene, size_t body) {
    const scene::Body& of = scene.bodies[body];
    if (!of.colour.empty()) return linear_colour(of.colour);
    if (!of.moves_at_all()) return linear_colour(kFixed);
    size_t before = 0;
    for (size_t i = 0; i < body; ++i) {
        if (scene.bodies[i].moves_at_all() && scene.bodies[i].colour.empty()) ++before;
    }
    return linear_colour(kBodies[before % kBodies.size()]);
}

Vec3 finger_colour(size_t finger) {
    return linear_colour(palette::finger(finger));
}

}  // namespace dihaptic::view
