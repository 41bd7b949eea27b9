// Tests joints that a file describes in the frame of a body.
#include <gtest/gtest.h>

#include "scene/test/read_text.h"

namespace dihaptic::scene::joint_places_test {
namespace {

const std::string kScene = R"(
bodies:
  - { name: mug, shape: box, size_mm: [40, 40, 40], position_mm: [100, 0, 50], rotation_deg: [0, 0, 90], mass_g: 100 }
  - { name: spoon, shape: box, size_mm: [10, 10, 90], position_mm: [100, 0, 120], mass_g: 20 }
joints:
  - { name: hook, kind: universal, in: mug, between: [mug, spoon], position_mm: [10, 0, 20], axis: [1, 0, 0], second_axis: [0, 1, 0] }
  - { name: thread, kind: distance, in: mug, between: [mug, spoon], second_position_mm: [0, 5, 30] }
  - { name: pad, kind: bushing, in: mug, between: [mug, spoon], rotation_deg: [0, 20, 0], stiffnesses_N_m: [1, 2, 3] }
)";

TEST(JointPlaces, AreTurnedIntoTheWorlds) {
    Diagnostics diagnostics;
    const Scene scene = read_text(kScene, diagnostics);
    for (const Problem& problem : diagnostics.problems()) ADD_FAILURE() << problem.text();
    ASSERT_EQ(scene.joints.size(), 3u);
    const Joint& hook = scene.joints[0];
    EXPECT_TRUE(hook.in.empty());
    EXPECT_LT((hook.position - Vec3(0.1, 0.01, 0.07)).norm(), 1e-12);
    EXPECT_LT((hook.axis - Vec3::UnitY()).norm(), 1e-12);
    EXPECT_LT((hook.second_axis + Vec3::UnitX()).norm(), 1e-12);
    EXPECT_LT((*scene.joints[1].second_position - Vec3(0.095, 0, 0.08)).norm(), 1e-12);
    const Quat turned = rotation_xyz({0, 0, 1.5707963267948966}) *
                        rotation_xyz({0, 20 * 3.14159265358979 / 180, 0});
    EXPECT_LT(rotation_xyz(scene.joints[2].rotation).angularDistance(turned), 1e-9);
}

TEST(JointPlaces, NameABodyThatThereIs) {
    std::string yaml = kScene;
    yaml.replace(yaml.find("in: mug"), 7, "in: mgu");
    Diagnostics diagnostics;
    read_text(yaml, diagnostics);
    ASSERT_TRUE(diagnostics.has_errors());
    EXPECT_NE(diagnostics.problems()[0].text().find("Did you mean mug?"), std::string::npos);
}

}  // namespace
}  // namespace dihaptic::scene::joint_places_test
