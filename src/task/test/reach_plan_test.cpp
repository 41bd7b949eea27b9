// Tests that how a trial's reach is measured comes out of trial-list.csv as it went in.
#include "task/reach_plan.h"

#include <cmath>

#include "session/test/reaches.h"

namespace dihaptic::task::reach_plan_test {
namespace {

TEST(ReachPlan, IsReadAsItWasFrozen) {
    session::Files files;
    const session::Plan plan = session::make_plan(files.request());
    const std::string list = files.folder.file("trial-list.csv");
    write_csv(frozen_list(*plan.task, plan.scene), list);
    const std::vector<ReachPlan> reaches = read_reaches(list);
    ASSERT_EQ(reaches.size(), plan.task->trials.size());
    for (size_t i = 0; i < reaches.size(); ++i) {
        const ReachPlan& reach = reaches[i];
        const bool far = plan.task->trials[i].condition == 1;
        EXPECT_EQ(reach.finger, "index");
        EXPECT_NEAR(reach.distance, 0.03, 1e-9);
        EXPECT_TRUE(reach.from_W.isApprox(Vec3(0, 0, 0.12)));
        EXPECT_TRUE(reach.to_W.isApprox(far ? Vec3(0, 0.05, 0.12) : Vec3(0.05, 0, 0.12)));
        EXPECT_EQ(reach.axis_W, Vec3::UnitZ());
        EXPECT_EQ(plan.task->phases().at(static_cast<size_t>(reach.phase)), "reach");
        EXPECT_EQ(reach.measure, Measure::angle);
    }
}

TEST(ReachPlan, IsReadByTheNamesOfItsColumns) {
    const testing::TemporaryFolder folder;
    const auto reaches = read_reaches(folder.write(
        "list.csv",
        "reach_measure,reach_phase,reach_at_mm,reach_finger,reach_from_z_mm,reach_to_y_mm\n"
        "extent,3,20,thumb,7,5\n"));
    ASSERT_EQ(reaches.size(), 1u);
    EXPECT_EQ(reaches[0].finger, "thumb");
    EXPECT_NEAR(reaches[0].distance, 0.02, 1e-12);
    EXPECT_NEAR(reaches[0].from_W.z(), 0.007, 1e-12);
    EXPECT_NEAR(reaches[0].to_W.y(), 0.005, 1e-12);
    EXPECT_EQ(reaches[0].phase, 3);
    EXPECT_EQ(reaches[0].measure, Measure::extent);
}

TEST(ReachPlan, IsNotInTheListOfATaskWithoutReaches) {
    const testing::TemporaryFolder folder;
    EXPECT_TRUE(read_reaches(folder.write("list.csv", "trial_num,kind\n1,baseline\n")).empty());
}

TEST(ReachPlan, OfALineThatIsCutOffHasNoFinger) {
    const testing::TemporaryFolder folder;
    const auto reaches = read_reaches(
        folder.write("list.csv", "trial_num,reach_finger,reach_at_mm\n1,index,30\n2\n"));
    ASSERT_EQ(reaches.size(), 2u);
    EXPECT_EQ(reaches[1].finger, "");
    EXPECT_TRUE(std::isnan(reaches[1].distance));
}

}  // namespace
}  // namespace dihaptic::task::reach_plan_test
