// Tests the values of expressions computed from recorded frames.
#include "task/run/recorded.h"

#include <gtest/gtest.h>

namespace dihaptic::task::recorded_test {
namespace {

scene::Scene block_and_fingers() {
    scene::Scene scene;
    scene.bodies.resize(1);
    scene.bodies[0].name = "block";
    scene.fingers.resize(2);
    scene.fingers[0].name = "thumb";
    scene.fingers[1].name = "index";
    return scene;
}

frame::Frame frame() {
    frame::Frame out;
    out.grip_force = 3;
    out.load_force = 1.5;
    out.fingers.resize(2);
    out.fingers[0].p_WH = {0.01, 0, 0};
    out.fingers[1].p_WH = {-0.03, 0, 0};
    out.fingers[1].v_WH = {0, 0.3, 0.4};
    out.bodies.resize(1);
    out.bodies[0].X_WB.p = {0, 0, 0.055};
    return out;
}

TEST(RecordedValue, IsThatOfTheFrameInUnitsThatPeopleRead) {
    for (const auto& [text, value, unit] : {
             std::tuple{"grip_force", 3.0, "N"},
             {"grip_force / load_force", 2.0, "1"},
             {"block.z - 20 mm", 35.0, "mm"},
             {"distance(thumb, index)", 40.0, "mm"},
             {"index.speed", 0.5, "m/s"},
             {"grip_force > 2", 1.0, "1"},
         }) {
        Diagnostics diagnostics;
        RecordedValue recorded(text, block_and_fingers(), diagnostics);
        ASSERT_TRUE(diagnostics.problems().empty()) << diagnostics.problems()[0].text();
        EXPECT_NEAR(recorded(frame()), value, 1e-12) << text;
        EXPECT_EQ(recorded.unit(), unit) << text;
    }
}

TEST(RecordedValue, OfAHandHasItsOwnGrip) {
    Quantities quantities({{"thumb", "index", "other thumb", "other index"},
                           {"block"},
                           {},
                           {},
                           {{"A", scene::FingerSet{3}}, {"B", scene::FingerSet{12}}}});
    frame::Frame now = frame();
    now.fingers.resize(4);
    const double x[] = {-0.02, 0.02, 0.08, 0.12};
    for (size_t i = 0; i < 4; ++i) now.fingers[i].p_WP = {x[i], 0, 0};
    // each finger presses one side of the block, which is body 0; the normals point from the block
    // to the proxy
    const double pressed[] = {2, 2.4, 3, 3};
    for (int i = 0; i < 4; ++i) {
        frame::ContactFrame contact;
        contact.a = 0;
        contact.b = 1 + i;
        contact.normal_force = pressed[i];
        contact.n_W = {i % 2 == 0 ? -1.0 : 1.0, 0, 0};
        now.contacts.push_back(contact);
    }
    const std::vector<frame::Handle> handles(4);
    for (const auto& [text, value] : {std::pair{"A.grip_force", 2.2}, {"B.grip_force", 3.0}}) {
        Diagnostics diagnostics;
        const Expression grip = Expression::compile(text, quantities, {}, "of", diagnostics);
        ASSERT_TRUE(diagnostics.problems().empty()) << diagnostics.problems()[0].text();
        quantities.update(now, handles);
        EXPECT_NEAR(grip(quantities.values()), value, 1e-12) << text;
        EXPECT_EQ(grip.dimension(), dimension(Quantity::force));
    }
}

TEST(RecordedValue, OfAMistakeIsNothing) {
    Diagnostics diagnostics;
    RecordedValue recorded("grip_forse + 1", block_and_fingers(), diagnostics);
    ASSERT_TRUE(diagnostics.has_errors());
    EXPECT_NE(diagnostics.problems()[0].text().find("grip_force"), std::string::npos);
    EXPECT_EQ(recorded(frame()), 0);
}

}  // namespace
}  // namespace dihaptic::task::recorded_test
