// Tests the conditions of states: expressions, hands, bodies, counts, and the error message for
// each mistake in a condition.
#include <gtest/gtest.h>

#include <memory>

#include "base/random.h"
#include "recording/raw_log.h"
#include "session/replay.h"
#include "session/test/reaches.h"
#include "task/run/task_director.h"

namespace dihaptic::task::conditions_test {
namespace {

constexpr int kBlock = 1;
constexpr int kThumb = 2;  // fingers are numbered after the bodies
constexpr int kIndex = 3;

/// A director that is called tick by tick, whose task waits for an exit in its only state. There
/// are two fingers, and a block in its initial position.
struct Waiting {
    explicit Waiting(const std::string& exit) {
        session::Files files;
        files.scene = std::string(session::kScene) +
                      "  - { name: thumb, shape: sphere, radius_mm: 6, mass_g: 1 }\n";
        files.scene.replace(files.scene.find("name: index"), 11, "name: thumb");
        files.scene.replace(files.scene.rfind("name: thumb"), 11, "name: index");
        files.experiment =
            "title: Wait\nscene: scene.yaml\nhand: { centre_mm: [0, 0, 120], aperture_mm: 80 }\n"
            "task:\n"
            "  hands: [{ name: left, fingers: [thumb, index] }]\n"
            "  regions: [{ name: goal, position_mm: [100, 0, 20], radius_mm: 10 }]\n"
            "  states:\n"
            "    - name: wait\n"
            "      exits:\n        - " +
            exit +
            "\n        - { when: time, after_s: 100, outcome: never }\n"
            "  blocks: [{ name: all }]\n";
        plan = session::make_plan(files.request());
        director = std::make_unique<TaskDirector>(*plan.task, 1, 1e-3);
        last.sequence = 0;
        last.fingers.resize(2);
        last.bodies.resize(2);
        last.bodies[kBlock].X_WB.p = {0, 0, 0.02};
        last.fingers[0].p_WP = last.fingers[1].p_WP = {0, 0, 1};
        commands.task.reserve({2});
        tick();  // begins the trial
    }
    /// Runs a tick. Returns whether the exit was taken.
    bool tick() {
        last.time += std::chrono::milliseconds(1);
        commands.task.clear();
        (*director)(last, handles, commands);
        return commands.task.outcome == 0;
    }
    /// Returns the number of ticks until the exit is taken, or -1 if it is not taken within `most`
    /// ticks.
    int ticks(int most) {
        for (int i = 1; i <= most; ++i) {
            if (tick()) return i;
        }
        return -1;
    }
    void press(int finger, double force = 1) {
        frame::ContactFrame& contact = last.contacts.emplace_back();
        contact.a = kBlock;
        contact.b = finger;
        contact.normal_force = force;
    }

    session::Plan plan;
    std::unique_ptr<TaskDirector> director;
    frame::Frame last;
    std::vector<frame::Handle> handles{{{0, 0, 1}, Vec3::Zero()}, {{0.1, 0, 1}, Vec3::Zero()}};
    frame::Commands commands;
};

TEST(Conditions, AnExpressionEndsAState) {
    Waiting task("{ when: 'grip_force > 2 and block.z - block.start.z > 5 mm', outcome: done }");
    EXPECT_FALSE(task.tick());
    task.last.grip_force = 3;
    EXPECT_FALSE(task.tick());
    task.last.bodies[kBlock].X_WB.p.z() = 0.026;
    task.last.grip_force = 1;
    EXPECT_FALSE(task.tick());
    task.last.grip_force = 3;
    EXPECT_TRUE(task.tick());
}

TEST(Conditions, AnExpressionHoldsAsLongAsItMust) {
    Waiting task("{ when: touched(block) or index.speed > 0.1, hold_s: 0.05, outcome: done }");
    task.press(kIndex);
    EXPECT_EQ(task.ticks(30), -1);
    task.last.contacts.clear();
    EXPECT_FALSE(task.tick());
    task.handles[1].v_WH = {0.2, 0, 0};  // velocity in the current tick
    EXPECT_EQ(task.ticks(100), 51);
}

TEST(Conditions, TimesAreExactToTheTick) {
    Waiting late("{ when: time_in_state >= 700 ms, outcome: done }");
    EXPECT_EQ(late.ticks(1000), 700);
    Waiting also("{ when: time_in_trial > 0.3, outcome: done }");
    EXPECT_EQ(also.ticks(1000), 301);
    Waiting number("{ when: trial_num == 1 and attempt == 1, outcome: done }");
    EXPECT_EQ(number.ticks(10), 1);
}

TEST(Conditions, ABodyAHandOrAFingerIsInARegion) {
    const Vec3 goal(0.1, 0, 0.02);
    Waiting body("{ when: inside, what: block, region: goal, outcome: done }");
    Waiting hand("{ when: inside, what: left, region: goal, outcome: done }");
    Waiting finger("{ when: inside, finger: index, region: goal, outcome: done }");
    for (Waiting* task : {&body, &hand, &finger}) EXPECT_FALSE(task->tick());
    body.last.bodies[kBlock].X_WB.p = goal;
    finger.handles[1].p_WH = goal;
    hand.handles[0].p_WH = goal + Vec3(0.04, 0, 0);
    hand.handles[1].p_WH = goal - Vec3(0.05, 0, 0);
    for (Waiting* task : {&body, &hand, &finger}) EXPECT_TRUE(task->tick());
}

TEST(Conditions, ABodyIsStill) {
    Waiting task("{ when: still, what: block, speed_mm_s: 10, outcome: done }");
    task.last.bodies[kBlock].v_WB = {0, 0.02, 0};
    EXPECT_FALSE(task.tick());
    task.last.bodies[kBlock].v_WB = {0, 0.005, 0};
    EXPECT_TRUE(task.tick());
}

TEST(Conditions, AHandGripsWithTwoOfItsFingers) {
    Waiting task("{ when: gripped, body: block, finger: left, outcome: done }");
    task.press(kThumb);
    EXPECT_FALSE(task.tick());
    task.press(kIndex, 0);  // a contact without force
    EXPECT_FALSE(task.tick());
    task.press(kIndex);
    EXPECT_TRUE(task.tick());
}

TEST(Conditions, AConditionIsMetSoManyTimes) {
    Waiting task("{ when: touched, body: block, count: 3, hold_s: 0.002, outcome: done }");
    for (int i = 0; i < 3; ++i) {
        task.press(kIndex);
        EXPECT_FALSE(task.tick());  // held too briefly to count
        task.last.contacts.clear();
        EXPECT_FALSE(task.tick());
    }
    for (int i = 0; i < 2; ++i) {
        task.press(kIndex);
        EXPECT_EQ(task.ticks(20), -1);
        task.last.contacts.clear();
        EXPECT_FALSE(task.tick());
    }
    task.press(kIndex);
    EXPECT_EQ(task.ticks(20), 3);
}

TEST(Conditions, ShortFormsAndFunctionsAgree) {
    const std::pair<std::string, std::string> pairs[] = {
        {"{ when: inside, region: goal, outcome: done }",
         "{ when: 'inside(hand, goal)', outcome: done }"},
        {"{ when: inside, finger: thumb, region: goal, shown: yes, outcome: done }",
         "{ when: 'inside(thumb.shown, goal)', outcome: done }"},
        {"{ when: touched, body: block, finger: thumb, outcome: done }",
         "{ when: 'touched(block, thumb)', outcome: done }"},
        {"{ when: gripped, body: block, outcome: done }",
         "{ when: gripped(block), outcome: done }"},
        {"{ when: lifted, body: block, height_mm: 30, outcome: done }",
         "{ when: 'lifted(block, 30 mm)', outcome: done }"},
        {"{ when: still, speed_mm_s: 20, outcome: done }",
         "{ when: 'still(left, 20 mm/s)', outcome: done }"}};
    for (const auto& [shorter, longer] : pairs) {
        Random random(3, longer);
        int done = 0;
        for (int i = 0; i < 5; ++i) {
            Waiting a(shorter);
            Waiting b(longer);
            for (int tick = 0; tick < 200; ++tick) {
                for (frame::Handle& handle : a.handles) {
                    handle.p_WH = Vec3(0.1 + random.normal() * 0.02, 0, 0.02);
                    handle.v_WH = Vec3(random.normal() * 0.1, 0, 0);
                }
                a.last.bodies[kBlock].X_WB.p.z() = 0.02 + random.normal() * 0.015;
                a.last.contacts.clear();
                for (const int finger : {kThumb, kIndex}) {
                    if (random.uniform(0, 1) < 0.1) a.press(finger);
                }
                b.handles = a.handles;
                b.last.bodies = a.last.bodies;
                b.last.contacts = a.last.contacts;
                const bool ended = a.tick();
                ASSERT_EQ(b.tick(), ended) << longer << tick;
                if (!ended) continue;
                ++done;
                break;
            }
        }
        EXPECT_GT(done, 0) << longer;
    }
}

TEST(Conditions, WhatComesByItselfIsKnown) {
    const auto comes = [](const std::string& exit) {
        return Waiting(exit).plan.task->states[0].transitions[0].comes();
    };
    EXPECT_TRUE(comes("{ when: time_in_state > 2, outcome: done }"));
    EXPECT_TRUE(comes("{ when: key, key: y, outcome: done }"));
    EXPECT_FALSE(comes("{ when: time_in_state > 2 and touched(block), outcome: done }"));
    EXPECT_FALSE(comes("{ when: touched, body: block, outcome: done }"));
}

TEST(Conditions, ASessionEndsItsStatesByThemAndIsReplayed) {
    session::Files files;
    files.replace("{ when: outside, region: shell, outcome: reached, feedback: Good }",
                  "{ when: 'outside(index, shell) and index.speed > 5 mm/s', outcome: reached }");
    const session::Plan plan = session::make_plan(files.request());
    const session::RunResult result = files.run(plan);
    recording::RawLogReader log(result.folder + "/raw.log");
    int reached = 0;
    while (const frame::Frame* frame = log.next()) {
        if (frame->task.outcome < 0) continue;
        const std::string& name =
            plan.task->outcomes[static_cast<size_t>(frame->task.outcome)].name;
        EXPECT_EQ(name, "reached");
        ++reached;
    }
    EXPECT_EQ(reached, 9);
    EXPECT_TRUE(session::replay_session(result.folder, session::kGoOn, {}).good());
}

using session::Mistake;

class MistakenCondition : public ::testing::TestWithParam<Mistake> {};

TEST_P(MistakenCondition, IsRefusedWithFileLineAndRemedy) {
    session::Files files;
    session::expect_refused(files, GetParam());
}

const char* const kExit = "{ when: outside, region: shell, outcome: reached, feedback: Good }";
const char* const kRegions = "  regions:\n";

INSTANTIATE_TEST_SUITE_P(
    Conditions, MistakenCondition,
    ::testing::Values(
        Mistake{kExit, "{ when: touchd, body: block, outcome: reached }",
                "Did you mean when: touched?"},
        Mistake{kExit, "{ when: perhaps, outcome: reached }", "or an expression"},
        Mistake{kExit, "{ when: '', outcome: reached }", "is empty"},
        Mistake{kExit, "{ when: grip_forc > 2, outcome: reached }", "Did you mean grip_force?"},
        Mistake{kExit, "{ when: 2 + load_force, outcome: reached }", "is not a condition"},
        Mistake{kExit, "{ when: grip_force, outcome: reached }", "e.g. grip_force > 2"},
        Mistake{kExit, "{ when: block.z > 2 N, outcome: reached }", "column 9: one side is in m"},
        Mistake{kExit, "{ when: touched(block), body: block, outcome: reached }",
                "It belongs to when: touched, released, gripped, lifted"},
        Mistake{kExit, "{ when: still, region: shell, outcome: reached }",
                "It belongs to when: inside, outside"},
        Mistake{kExit, "{ when: key, key: y, height_mm: 3, outcome: reached }",
                "It belongs to when: lifted"},
        Mistake{kExit, "{ when: time, after_s: 1, count: 3, outcome: reached }",
                "It belongs to when: inside"},
        Mistake{kExit, "{ when: outside, region: shell, count: 0, outcome: reached }", "count"},
        Mistake{kExit, "{ when: outside, region: shell, what: blok, outcome: reached }",
                "Did you mean block?"},
        Mistake{kExit,
                "{ when: outside, region: shell, what: block, finger: index, outcome: reached }",
                "duplicates the key 'what'"},
        Mistake{kExit,
                "{ when: outside, region: shell, what: block, shown: yes, outcome: reached }",
                "not to bodies"},
        Mistake{kExit, "{ when: outside, region: shell, finger: left, outcome: reached }",
                "nor a hand of the task"},
        Mistake{kRegions, "  hands: [{ name: index, fingers: [index] }]\n  regions:\n",
                "is a finger, a body or a joint of the scene"},
        Mistake{kRegions, "  hands: [{ name: left, fingers: [thumb] }]\n  regions:\n",
                "a finger of the scene"},
        Mistake{kRegions, "  hands: [{ name: left, fingers: [] }]\n  regions:\n", "there are none"},
        Mistake{kRegions, "  hands: [{ name: left }]\n  regions:\n", "fingers"}));

}  // namespace
}  // namespace dihaptic::task::conditions_test
