// Tests the curves and sentences of a session's page on frames and tables whose figures are known.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

#include "analysis/report/lift_curves.h"
#include "analysis/report/methods_text.h"
#include "analysis/report/reach_paths.h"
#include "testing/files.h"

namespace dihaptic::analysis::curves_test {
namespace {

constexpr double kTick = 1e-3;

struct Session {
    testing::TemporaryFolder folder;
    std::string trials = "trial_num,attempt,kind,condition,block,perturbation,outcome\n";
    std::string lifts = "trial_num,attempt,lift,lift_off_s\n";

    SessionData data() {
        folder.write("session.yaml", "");
        return {recording::SessionFolder::open_tables(folder.path()),
                {},
                {},
                rows::TrialFile(folder.write("trials.csv", trials)),
                rows::LiftFile(folder.write("lifts.csv", lifts)),
                {},
                {},
                {},
                {}};
    }
};

std::string origin() {
    return "made up";
}

/// Whether the page has a value of a series at a time, as "name ... y".
bool has(const std::string& page, const std::string& what) {
    return page.find(what) != std::string::npos;
}

TEST(LiftCurves, AreAlignedAtLiftOffByConditionAndPerturbation) {
    Session session;
    session.trials +=
        "1,1,baseline,light,a,,held\n2,1,catch,light,a,load,held\n3,1,baseline,light,a,,held\n";
    session.lifts += "1,1,complete,2\n2,1,complete,5\n3,1,not lifted,\n";
    const SessionData data = session.data();
    LiftCurves curves(data, kTick);
    frame::Frame frame;
    for (int i = 0; i < 8000; ++i) {
        frame.sequence = i;
        frame.time = std::chrono::milliseconds(i);
        // grip rises by 1 N a second from 10 N at the first lift-off
        frame.grip_force = 10 + (i * kTick - 2);
        frame.load_force = i < 2000 ? 0 : 3;
        curves.see(frame);
    }
    Page page("t", "w", "o");
    curves.add_to(page, origin());
    const std::string html = page.html();
    EXPECT_TRUE(has(html, "Lifts: light&quot;"));
    EXPECT_TRUE(has(html, "Lifts: light, load, catch&quot;"));
    EXPECT_TRUE(has(html, "1 complete lift; mean"));
    EXPECT_FALSE(has(html, "trial 3"));
    // from 0.6 s before lift-off on, in steps of 10 ms
    EXPECT_TRUE(has(html, "[9.4,9.41,9.42,"));
    EXPECT_TRUE(has(html, "[12.4,12.41,12.42,"));
}

TEST(LiftCurves, LeaveOutTicksThatAreMissing) {
    Session session;
    session.lifts += "1,1,complete,2\n";
    const SessionData data = session.data();
    LiftCurves curves(data, kTick);
    frame::Frame frame;
    for (int i = 0; i < 4000; ++i) {
        if (i > 1404 && i < 1435) continue;
        frame.time = std::chrono::milliseconds(i);
        frame.grip_force = i;
        curves.see(frame);
    }
    Page page("t", "w", "o");
    curves.add_to(page, origin());
    EXPECT_TRUE(has(page.html(), "[1400.0,null,null,null,1440.0,")) << page.html().substr(0, 0);
}

TEST(ReachPaths, AreTurnedSoThatTheTargetIsAbove) {
    Session session;
    session.trials += "1,1,baseline,,straight,,reached\n2,1,perturbed,,turned,rotation,reached\n";
    // to the right of the start, and away from the person; left is then away, and to the left
    session.folder.write("trial-list.csv",
                         "reach_finger,reach_at_mm,reach_from_x_mm,reach_from_y_mm,reach_from_z_mm,"
                         "reach_to_x_mm,reach_to_y_mm,reach_to_z_mm,reach_axis_x,reach_axis_y,"
                         "reach_axis_z,reach_phase,reach_measure\n"
                         "index,50,0,0,0,100,0,0,0,0,1,2,angle\n"
                         "index,50,0,0,0,0,100,0,0,0,1,2,angle\n");
    SessionData data = session.data();
    data.task.reach.emplace();
    recording::LogHead head;
    head.fingers = {"thumb", "index"};
    ReachPaths paths(data, head);
    frame::Frame frame;
    frame.fingers.resize(2);
    frame.task.attempt = 1;
    for (int trial = 1; trial <= 2; ++trial) {
        for (int i = 0; i <= 100; ++i) {
            frame.sequence = trial * 1000 + i;
            frame.trial = trial;
            frame.phase = i == 0 ? 1 : 2;
            const double along = 1e-3 * i;
            const Vec3 arm = trial == 1 ? Vec3(along, 0.1 * along, 0) : Vec3(0.1 * along, along, 0);
            frame.fingers[1].p_WH = arm;
            paths.see(frame);
        }
    }
    Page page("t", "w", "o");
    paths.add_to(page, origin());
    const std::string html = page.html();
    EXPECT_TRUE(has(html, "straight (1)"));
    EXPECT_TRUE(has(html, "turned (1)"));
    // the last point that is drawn, 96 ticks after the first: 0.96 of the line, and a tenth of it
    // to the left in the first panel, to the right in the second
    const auto last = [&](double panel, double left) {
        return fmt::format("L{:.1f} {:.1f}\"", 230 * panel + 115 - 150 * left,
                           24 + 230 - 45 - 150 * 0.96);
    };
    EXPECT_TRUE(has(html, last(0, 0.096))) << last(0, 0.096);
    EXPECT_TRUE(has(html, last(1, -0.096))) << last(1, -0.096);
}

TEST(ReachPaths, AreNoneOfATaskWithoutReaches) {
    Session session;
    const SessionData data = session.data();
    ReachPaths paths(data, {});
    frame::Frame frame;
    frame.trial = 1;
    paths.see(frame);
    Page page("t", "w", "o");
    const std::string before = page.html();
    paths.add_to(page, origin());
    EXPECT_EQ(page.html(), before);
}

TEST(MethodsText, SaysWhatWasDoneAndFound) {
    Session session;
    session.trials =
        "trial_num,attempt,kind,round,condition,block,perturbation,outcome\n"
        "1,1,baseline,one,left,first,,reached\n2,1,baseline,one,right,first,,reached\n"
        "2,2,baseline,one,right,first,,too late\n3,1,perturbed,two,left,first,turn,reached\n";
    session.folder.write(
        "settings.csv",
        "setting,value,origin\nrate_Hz,2000,default\ndynamics.solver,newton,default\n"
        "coupling.stiffness_N_m,700,rig\n");
    SessionData data = session.data();
    data.info.title = "Reaches";
    data.info.seed = "7";
    data.info.program = "dihaptic 9";
    data.info.participant = {"S07", "24", "F", "right"};
    data.info.moved_by.mover = recording::Mover::devices;
    data.info.devices.resize(1);
    data.info.devices[0].finger = "index";
    data.info.devices[0].model = "Premium 1.0";
    data.task.states.resize(2);
    data.task.states[0].name = "home";
    data.task.states[1].name = "reach";
    Table lifts{{{"trials", ""}, {"preload_s", ""}, {"slips", ""}}, {{"all", 0.1234, kUnmeasured}}};
    const MethodsText text = methods_text(data, SessionPage{Page("t", "w", "o")}, {}, lifts);
    ASSERT_EQ(text.methods.size(), 2u);
    EXPECT_EQ(text.methods[0],
              "Participant S07 (24 years, sex F, right-handed) took part. Forces were computed and "
              "recorded 2000 times a second by dihaptic 9, and rendered to index (Premium 1.0) "
              "through its device. Device and virtual finger were connected by a virtual coupling "
              "of 700 N/m. Contact and friction were solved with the method newton.");
    EXPECT_EQ(
        text.methods[1],
        "The session (\"Reaches\", seed 7) had 2 rounds (one and two), each with 1 block: "
        "first (2 trials, baseline). There were 2 conditions: left and right. Each trial went "
        "through 2 states: home and reach.");
    ASSERT_EQ(text.results.size(), 2u);
    EXPECT_EQ(text.results[0], "Outcomes of 4 attempts: 3 reached and 1 too late.");
    EXPECT_EQ(text.results[1], "Lifts, all (medians): preload_s 0.123.");
}

}  // namespace
}  // namespace dihaptic::analysis::curves_test
