// Tests that the plan for measuring a trial's reach is unchanged when it is read back from
// trial-list.csv.
#include "task/plan/reach_plan.h"

#include <cmath>
#include <map>

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
        EXPECT_EQ(plan.task->phases().at(static_cast<size_t>(reach.phase_numbers().at(0))),
                  "reach");
        EXPECT_EQ(reach.measure, Measure::angle);
    }
}

TEST(ReachPlan, MayNameSeveralStates) {
    session::Files files;
    files.replace("during: reach,", "during: [home, reach],");
    const session::Plan plan = session::make_plan(files.request());
    const std::string list = files.folder.file("trial-list.csv");
    write_csv(frozen_list(*plan.task, plan.scene), list);
    EXPECT_EQ(read_reaches(list).at(0).phase_numbers(), (std::vector<int>{1, 2}));
}

TEST(MovementPlan, IsReadAsItWasFrozen) {
    session::Files files;
    files.replace("  states:", R"(    - name: curl
      field: { kind: curl, on: index, damping_Ns_m: 15, axis: [0, 0, 1] }
    - name: back
      field: { kind: curl, on: index, damping_Ns_m: -7.5, axis: [0, 0, 1] }
  measures: [channel_force, adaptation_index]
  states:)");
    files.experiment += R"(    - { name: field, kind: perturbed, perturb: curl, repeats: 1 }
    - { name: opposite, kind: perturbed, perturb: back, repeats: 1 }
    - { name: held, kind: force_channel, perturb: channel, repeats: 1 }
)";
    const session::Plan plan = session::make_plan(files.request());
    const std::string list = files.folder.file("trial-list.csv");
    write_csv(frozen_list(*plan.task, plan.scene), list);
    const std::vector<MovementPlan> movements = read_movements(list);
    ASSERT_EQ(movements.size(), plan.task->trials.size());
    const std::map<std::string, double> shares{
        {"before", 0}, {"turned", 0}, {"field", 1}, {"opposite", -0.5}};
    for (size_t i = 0; i < movements.size(); ++i) {
        const MovementPlan& movement = movements[i];
        const Trial& trial = plan.task->trials[i];
        const std::string block = plan.task->task.blocks[static_cast<size_t>(trial.block)].name;
        const Vec3 along = trial.condition == 1 ? Vec3::UnitY() : Vec3::UnitX();
        EXPECT_TRUE(movement.along_W().isApprox(along));
        EXPECT_TRUE(movement.left_W().isApprox(Vec3::UnitZ().cross(along)));
        EXPECT_EQ(movement.channel == 1, block == "held");
        EXPECT_TRUE((movement.ideal * Vec3::UnitX()).isApprox(Vec3(0, 15, 0)));
        EXPECT_EQ(std::isnan(movement.field_share), movement.channel == 1);
        const auto share = shares.find(block);
        EXPECT_TRUE(share == shares.end() || movement.field_share == share->second) << block;
    }
    EXPECT_EQ(read_reaches(list).size(), movements.size());
}

TEST(MovementPlan, HasNoLeftWhereTheAxisLiesAlongTheLine) {
    MovementPlan movement;
    movement.to_W = {0, 0, 0.1};
    EXPECT_TRUE(movement.left_W().array().isNaN().all());
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
    EXPECT_EQ(reaches[0].phase_numbers(), std::vector<int>{3});
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
