#include "frame/task_frame.h"

#include <gtest/gtest.h>

#include <cstddef>

namespace dihaptic::frame::task_frame_test {
namespace {

TEST(TaskFrame, HasNoListThatIsNotDeclared) {
    TaskFrame task;
    size_t count = 0;
    TaskFrame::visit_lists(task, [&](const auto&, const TaskList&) { ++count; });
    EXPECT_EQ(sizeof task, offsetof(TaskFrame, visual) + count * sizeof task.visual)
        << "a list is missing in visit_lists()";
}

TEST(TaskFrame, HoldsAsMuchAsIsReserved) {
    TaskFrame task;
    const Sizes sizes{.bodies = 5, .fingers = 3};
    task.reserve(sizes);
    TaskFrame::visit_lists(task, [&](const auto& list, const TaskList& is) {
        EXPECT_GE(list.capacity(), is.most(sizes)) << is.name;
        EXPECT_GT(is.most(sizes), 0u) << is.name;
    });
    task.fill(sizes);
    EXPECT_EQ(task.placements.size(), 5u);
    EXPECT_EQ(task.looks.size(), 8u);
    EXPECT_EQ(task.displaced.size(), 4u);
    task.clear();
    TaskFrame::visit_lists(
        task, [](const auto& list, const TaskList& is) { EXPECT_TRUE(list.empty()) << is.name; });
}

TEST(TaskFrame, KnowsWhatIsAPerturbation) {
    TaskFrame task;
    EXPECT_FALSE(task.perturbed());
    task.motors.resize(1);
    task.targets.resize(1);
    EXPECT_FALSE(task.perturbed());
    task.joint_properties.resize(1);
    EXPECT_TRUE(task.perturbed());
}

}  // namespace
}  // namespace dihaptic::frame::task_frame_test
