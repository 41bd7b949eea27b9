#include "view/colours.h"

#include <gtest/gtest.h>

namespace dihaptic::view::colours_test {
namespace {

/// Colours as seen by people without red cones (protanopia) or green cones (deuteranopia). Machado,
/// Oliveira, Fernandes, "A physiologically-based model for simulation of color vision deficiency"
/// (2009), severity 1.
Mat3 without_red() {
    Mat3 m;
    m << 0.152286, 1.052583, -0.204868, 0.114503, 0.786281, 0.099216, -0.003882, -0.048116,
        1.051998;
    return m;
}
Mat3 without_green() {
    Mat3 m;
    m << 0.367322, 0.860646, -0.227968, 0.280085, 0.672501, 0.047413, -0.011820, 0.042940, 0.968881;
    return m;
}

/// CIE 1976 L*a*b* coordinates of a linear sRGB colour, with white point D65.
Vec3 lab(const Vec3& rgb) {
    Mat3 m;
    m << 0.4124, 0.3576, 0.1805, 0.2126, 0.7152, 0.0722, 0.0193, 0.1192, 0.9505;
    const Vec3 xyz = (m * rgb.cwiseMax(0)).cwiseQuotient(Vec3(0.9505, 1, 1.089));
    const auto f = [](double t) { return t > 0.008856 ? std::cbrt(t) : 7.787 * t + 16.0 / 116; };
    return {116 * f(xyz.y()) - 16, 500 * (f(xyz.x()) - f(xyz.y())),
            200 * (f(xyz.y()) - f(xyz.z()))};
}

TEST(Colours, FingersAndTheBlockDifferForEveryKindOfColourVision) {
    std::vector<Vec3> colours{linear_colour("#3b7dd8"), linear_colour("#c9c4b8")};
    for (size_t i = 0; i < 5; ++i) colours.push_back(finger_colour(i));
    for (const Mat3& sees : {Mat3(Mat3::Identity()), without_red(), without_green()}) {
        for (size_t i = 0; i < colours.size(); ++i) {
            for (size_t j = 0; j < i; ++j) {
                const bool first_two = i == 3 && j == 2;  // thumb and index
                // a difference of 2.3 is just noticeable
                EXPECT_GT((lab(sees * colours[i]) - lab(sees * colours[j])).norm(),
                          first_two ? 40 : 15)
                    << i << " " << j;
            }
        }
    }
}

TEST(Colours, BodiesWithoutOneGetOneEach) {
    scene::Scene scene;
    scene.bodies.resize(3);
    scene.bodies[2].fixed = true;
    EXPECT_NE(body_colour(scene, 0), body_colour(scene, 1));
    EXPECT_NE(body_colour(scene, 0), body_colour(scene, 2));
    scene.bodies[0].colour = "#ffffff";
    EXPECT_EQ(body_colour(scene, 0), Vec3::Ones());
}

}  // namespace
}  // namespace dihaptic::view::colours_test
