// Tests which targets a picture of a whole experiment shows.
#include "task/plan/shown_targets.h"

#include "session/test/reaches.h"

namespace dihaptic::task::shown_targets_test {
namespace {

std::vector<frame::TargetFrame> targets_of(session::Files& files) {
    const session::Plan plan = session::make_plan(files.request());
    return shown_targets(*plan.task);
}

TEST(ShownTargets, AreThoseOfAllStatesAndConditionsEachOnce) {
    session::Files files;
    const auto targets = targets_of(files);
    ASSERT_EQ(targets.size(), 3u);  // the start, which both conditions have, and both targets
    EXPECT_TRUE(targets[0].p_WT.isApprox(Vec3(0, 0, 0.12)));
    EXPECT_TRUE(targets[1].p_WT.isApprox(Vec3(0.05, 0, 0.12)));
    EXPECT_TRUE(targets[2].p_WT.isApprox(Vec3(0, 0.05, 0.12)));
    for (const auto& target : targets) EXPECT_DOUBLE_EQ(target.radius, 0.006);
}

TEST(ShownTargets, HaveTheColourOfTheirStateOrAreHidden) {
    session::Files files;
    files.replace("      marker: 7\n",
                  "      marker: 7\n      look: [{ target: target, colour: \"#0000ff\" }]\n");
    EXPECT_EQ(targets_of(files)[1].colour, 255);
    files.replace("colour: \"#0000ff\"", "hidden: yes");
    EXPECT_EQ(targets_of(files).size(), 1u);
}

}  // namespace
}  // namespace dihaptic::task::shown_targets_test
