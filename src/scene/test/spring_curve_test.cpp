// Tests spring curves: their segments, and mistakes in files.
#include "scene/spring_curve.h"

#include <gtest/gtest.h>

#include "scene/test/read_text.h"

namespace dihaptic::scene::spring_curve_test {
namespace {

TEST(SpringCurve, IsStraightBetweenItsPointsAndBeyondThem) {
    const SpringCurve curve{{-1, 0, 2}, {-3, 0, 1}};
    for (const auto& [x, resistance, stiffness] :
         {std::array{-2.0, -6.0, 3.0}, {-0.5, -1.5, 3.0}, {1.0, 0.5, 0.5}, {4.0, 2.0, 0.5}}) {
        EXPECT_DOUBLE_EQ(curve.at(x).resistance, resistance) << x;
        EXPECT_DOUBLE_EQ(curve.at(x).stiffness, stiffness) << x;
    }
}

std::string first_problem(const std::string& joint) {
    Diagnostics diagnostics;
    read_text(
        "bodies:\n  - {name: b, shape: sphere, radius_mm: 4, mass_g: 1}\njoints:\n  - {name: j, "
        "between: [b], " +
            joint + "}\n",
        diagnostics);
    return diagnostics.problems().empty() ? "" : diagnostics.problems()[0].text();
}

TEST(SpringCurve, OfAFileHasPointsThatAscend) {
    EXPECT_EQ(first_problem("kind: slider, curve_at_mm: [-1, 0, 2], curve_N: [-3, 0, 1]"), "");
    EXPECT_EQ(first_problem("kind: hinge, curve_at_deg: [-1, 2], curve_mNm: [-3, 1]"), "");
    for (const auto& [joint, said] : {
             std::pair{"kind: slider, curve_at_mm: [0, 1], curve_N: [0]", "has 2 stretches and 1"},
             {"kind: slider, curve_N: [0, 1]", "has 0 stretches and 2"},
             {"kind: slider, curve_at_mm: [0], curve_N: [0]", "needs two or more"},
             {"kind: slider, curve_at_mm: [0, 2, 1], curve_N: [0, 1, 2]", "does not ascend"},
             {"kind: slider, curve_at_mm: [0, 0.001], curve_N: [0, 100]", "steeper than"},
             {"kind: slider, curve_at_mm: [0, 1], curve_N: [0, 1], stiffness_N_m: 5",
              "cannot be combined with a curve"},
             {"kind: ball, curve_at_deg: [0, 1], curve_Nm: [0, 1]", "no single axis"},
             {"kind: hinge, curve_at_mm: [0, 1], curve_Nm: [0, 1]", "is not a unit of angle"},
         }) {
        EXPECT_NE(first_problem(joint).find(said), std::string::npos)
            << joint << ": " << first_problem(joint);
    }
}

}  // namespace
}  // namespace dihaptic::scene::spring_curve_test
