// Tests the bodies and joints that are made from lattices, and mistakes in files with lattices.
#include "scene/lattice.h"

#include <gtest/gtest.h>

#include "base/field_writer.h"
#include "scene/test/read_text.h"

namespace dihaptic::scene::lattice_test {
namespace {

const char* const kScene = R"(
bodies:
  - { name: table, shape: box, size_mm: [600, 400, 50], position_mm: [0, 0, -25], fixed: yes }
lattices:
  - name: sponge
    size_mm: [60, 40, 30]
    parts: [2, 2, 1]
    position_mm: [0, 0, 15]
    rotation_deg: [0, 0, 90]
    mass_g: 40
    young_kPa: 20
    retardation_ms: 10
    glued: [{ side: -z, to: table }]
joints:
  - { name: first, kind: ball, between: [sponge_1_1_1] }
)";

TEST(Lattices, BecomeBlocksAndBushings) {
    Diagnostics diagnostics;
    const Scene scene = read_text(kScene, diagnostics);
    for (const Problem& problem : diagnostics.problems()) ADD_FAILURE() << problem.text();
    ASSERT_EQ(scene.bodies.size(), 5u);
    EXPECT_TRUE(scene.lattices.empty());
    const Body& block = scene.bodies[static_cast<size_t>(scene.find("sponge_2_1_1"))];
    // the lattice's x axis is the world's y axis
    EXPECT_LT((block.position - Vec3(0.01, 0.015, 0.015)).norm(), 1e-12);
    EXPECT_DOUBLE_EQ(mass(block), 0.01);
    EXPECT_EQ(block.group, "sponge");
    // the file's own joint first, then four links between neighbours and four that glue the lattice
    ASSERT_EQ(scene.joints.size(), 9u);
    EXPECT_EQ(scene.joints[0].name, "first");
    EXPECT_EQ(recorded_joints(scene).size(), 1u);
    const Joint& link = scene.joints[1];
    EXPECT_EQ(link.between, (std::vector<std::string>{"sponge_1_1_1", "sponge_2_1_1"}));
    EXPECT_NEAR(link.stiffnesses.x(), 20e3 * 0.02 * 0.03 / 0.03, 1e-9);
    EXPECT_NEAR(link.stiffnesses.y(), 10e3 * 0.02 * 0.03 / 0.03, 1e-9);
    EXPECT_NEAR(link.turn_stiffnesses.z(), 20e3 * 0.03 * std::pow(0.02, 3) / 12 / 0.03, 1e-12);
    EXPECT_NEAR(link.dampings.x(), 0.01 * link.stiffnesses.x(), 1e-12);
    const Joint& glue = scene.joints.back();
    EXPECT_EQ(glue.between.front(), "table");
    EXPECT_NEAR(glue.position.z(), 0, 1e-12);
    EXPECT_NEAR(glue.stiffnesses.z(), 20e3 * 0.03 * 0.02 / 0.015, 1e-9);
}

TEST(Lattices, StayTheSameOnceTheyAreWrittenAsBlocks) {
    Diagnostics diagnostics;
    const Scene scene = read_text(kScene, diagnostics);
    const Scene again = read_text(to_yaml(write_fields(scene)), diagnostics);
    for (const Problem& problem : diagnostics.problems()) ADD_FAILURE() << problem.text();
    EXPECT_EQ(to_yaml(write_fields(again)), to_yaml(write_fields(scene)));
}

struct Mistake {
    const char* from;
    const char* to;
    const char* says;
};

class MistakenLattice : public ::testing::TestWithParam<Mistake> {};

TEST_P(MistakenLattice, IsRefusedWithARemedy) {
    std::string yaml = kScene;
    const size_t at = yaml.find(GetParam().from);
    ASSERT_NE(at, std::string::npos);
    yaml.replace(at, std::string(GetParam().from).size(), GetParam().to);
    Diagnostics diagnostics;
    read_text(yaml, diagnostics);
    std::string all;
    for (const Problem& problem : diagnostics.problems()) all += problem.text() + "\n";
    EXPECT_NE(all.find(GetParam().says), std::string::npos) << all;
    EXPECT_NE(all.find("scene.yaml:"), std::string::npos) << all;
}

INSTANTIATE_TEST_SUITE_P(
    Lattices, MistakenLattice,
    ::testing::Values(Mistake{"parts: [2, 2, 1]", "parts: [2, 2, 0]", "parts"},
                      Mistake{"parts: [2, 2, 1]", "parts: [2, 2.5, 1]", "not a whole number"},
                      Mistake{"parts: [2, 2, 1]", "parts: [9, 9, 9]", "more than 200"},
                      Mistake{"mass_g: 40", "colour: \"#ffffff\"", "Give mass_g"},
                      Mistake{"to: table", "to: tabel", "there is no body 'tabel'"},
                      Mistake{"side: -z", "side: -w", "side"},
                      Mistake{"young_kPa: 20", "young_N: 20", "young"},
                      Mistake{"size_mm: [60, 40, 30]", "size_mm: [60, 40, 0]", "size"},
                      Mistake{"kind: ball,", "kind: ball, stiffnesses_N_m: [1, 1, 1],",
                              "belongs to a bushing"},
                      Mistake{"kind: ball,", "kind: bushing,", "stiffnesses_N_m: ["}));

}  // namespace
}  // namespace dihaptic::scene::lattice_test
