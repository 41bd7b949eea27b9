// Tests the list of quantities from which curves are chosen.
#include "drawable.h"

#include <gtest/gtest.h>

#include <map>

namespace dihaptic::gui::drawable_test {
namespace {

std::map<std::string, std::string> quantities_of(const char* file) {
    Diagnostics diagnostics;
    const scene::Scene scene = scene::read_scene(file, diagnostics);
    diagnostics.throw_if_errors();
    std::map<std::string, std::string> out;
    for (const Choice& choice : drawable_quantities(scene)) {
        EXPECT_TRUE(out.emplace(choice.word, choice.what).second) << choice.word;
        EXPECT_FALSE(choice.what.empty()) << choice.word;
    }
    return out;
}

TEST(Drawable, QuantitiesHaveTheMeaningOfTheirThing) {
    auto quantities = quantities_of("scenes/block-on-table.yaml");
    EXPECT_EQ(quantities["block.position.z"], "Position of the body's origin. [mm]");
    EXPECT_EQ(quantities["block.z"], quantities["block.position.z"]);
    EXPECT_EQ(quantities["thumb.z"], "Position of the handle. [mm]");
    EXPECT_EQ(quantities["thumb.speed"], "Speed. [m/s]");
    EXPECT_EQ(quantities["thumb.force_sent.x"].substr(0, 5), "Force");
    EXPECT_NE(quantities["grip_force"].find("Pinch component"), std::string::npos);
}

TEST(Drawable, QuantitiesAreNumbersThatARecordingHas) {
    const auto quantities = quantities_of("scenes/door.yaml");
    for (const char* name : {"thumb.handle_position", "block", "time_in_state", "trial_num"})
        EXPECT_FALSE(quantities.contains(name)) << name;
    EXPECT_TRUE(quantities.contains("trial"));
}

}  // namespace
}  // namespace dihaptic::gui::drawable_test
