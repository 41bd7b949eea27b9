// Tests the measures of behaviour against closed forms, and checks that their page in docs matches
// the table in the code.
#include "analysis/measures/measures.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <fstream>

#include "analysis/test/reaches.h"
#include "base/figure.h"
#include "testing/files.h"

namespace dihaptic::analysis::measures_test {
namespace {

constexpr const char* kPage = "docs/measures-of-behaviour.md";

/// Time from the beginning of the movement at which the minimum-jerk speed rises through 5 cm/s.
double rise() {
    double low = 0;
    double high = 0.25;
    for (int i = 0; i < 100; ++i) {
        const double u = (low + high) / 2 / 0.5;
        (0.2 * 30 * u * u * (1 - u) * (1 - u) < 0.05 ? low : high) = (low + high) / 2;
    }
    return low;
}

TEST(Measures, OfAMinimumJerkReachAreItsClosedForms) {
    const Reach reach;
    EXPECT_NEAR(reach.value("reaction_time"), 0.3 + rise(), kTick);
    EXPECT_NEAR(reach.value("movement_time"), 0.5 - 2 * rise(), 2 * kTick);
    EXPECT_NEAR(reach.value("peak_speed"), 0.375, 1e-12);
    EXPECT_NEAR(reach.value("time_of_peak_speed"), 0.25 - rise(), kTick);
    const double u = rise() / 0.5;
    const double before = 0.1 * (10 * std::pow(u, 3) - 15 * std::pow(u, 4) + 6 * std::pow(u, 5));
    EXPECT_NEAR(reach.value("path_length"), 0.1 - 2 * before, 2 * kTick * 0.05);
    EXPECT_NEAR(reach.value("lateral_deviation"), 0, 1e-15);
    EXPECT_LT(reach.value("end_point_error", 1), 0);  // the last, slow part is not included
    EXPECT_NEAR(reach.value("end_point_error"), -reach.value("end_point_error", 1), 1e-15);
    EXPECT_NEAR(reach.value("initial_direction"), 0, 1e-12);
    EXPECT_TRUE(reach.take("movement_time").why.empty());
}

TEST(Measures, OfAnObliqueReachHaveTheirSign) {
    const Reach reach(0.02);  // a reach to the left of the line
    EXPECT_NEAR(reach.value("initial_direction"), std::atan(0.2), 1e-9);
    EXPECT_NEAR(reach.value("lateral_deviation"), 0.02, 1e-3);
    EXPECT_NEAR(reach.value("lateral_deviation", 1), 0.01, 1e-5);
    EXPECT_NEAR(reach.value("lateral_deviation", 2), 0.1 * 0.02 / 2 * 1e6,
                30);  // area of a triangle [mm^2]
    EXPECT_NEAR(reach.value("end_point_error", 2), 0.02, 1e-3);
    EXPECT_LT(Reach(-0.02).value("lateral_deviation"), -0.019);
}

TEST(Measures, OfForceInAChannelAreTheSharesThatThePersonPressesWith) {
    Reach reach;
    EXPECT_EQ(reach.take("channel_force").why, "no channel");
    EXPECT_TRUE(std::isnan(reach.value("adaptation_index")));
    reach.attempt.plan.field_share = -1;
    EXPECT_EQ(reach.value("adaptation_index", 4), -1);  // a field acted, without a channel
    reach.attempt.plan.channel = 1;
    reach.attempt.plan.field_share = kUnmeasured;
    // the field pushes left with 15 v; the hand presses right with 0.6 of that, and leans
    EXPECT_NEAR(reach.value("adaptation_index", 1), 0.6, 1e-12);
    EXPECT_NEAR(reach.value("adaptation_index", 2), 0.2, 1e-12);
    EXPECT_NEAR(reach.value("adaptation_index", 3), 1, 1e-12);
    EXPECT_LT(reach.value("adaptation_index"), 0.6);
    EXPECT_NEAR(reach.value("channel_force", 1), -0.6 * 15 * 0.375 + 0.2, 1e-9);
    EXPECT_NEAR(reach.value("channel_force"), -0.6 * 15 * 0.375 + 0.2, 1e-9);
    EXPECT_NEAR(reach.value("channel_force", 2),
                -0.6 * 15 * reach.value("path_length") + 0.2 * reach.value("movement_time"), 1e-4);
    reach.attempt.share = 0;  // the perturbation did not act
    EXPECT_EQ(reach.take("adaptation_index").why, "no channel");
}

TEST(Measures, OfALateFieldCompareWithItsForceAsLate) {
    Reach reach;
    reach.attempt.plan.channel = 1;
    reach.attempt.plan.field_share = kUnmeasured;
    reach.attempt.plan.ideal_delay = 0.07;
    EXPECT_LT(reach.value("adaptation_index", 1), 0.55);  // the hand presses too early
    std::vector<MotionSample>& samples = reach.attempt.samples;
    for (size_t i = samples.size(); i-- > 70;) samples[i].f_W = samples[i - 70].f_W;
    EXPECT_NEAR(reach.value("adaptation_index", 1), 0.6, 1e-12);
    EXPECT_NEAR(reach.value("adaptation_index", 3), 1, 1e-12);
}

TEST(Measures, AMovementGoesOnAfterAPauseThatIsShorterThanItsEnd) {
    Reach reach;  // a second stroke follows 0.2 s after the end of the first one
    for (size_t i = 2000; i < 2100; ++i) reach.attempt.samples[i].v_W = {0.06, 0, 0};
    const double first = reach.value("movement_time");
    EXPECT_LT(first, 0.5);
    reach.options.end_still = 0.15;
    EXPECT_EQ(reach.value("movement_time"), first);
    reach.options.end_still = 0.3;  // the states end 0.1 s after the second stroke
    EXPECT_EQ(reach.take("movement_time").why, "the movement was not over when its states ended");
    reach.attempt.samples.resize(2100);
    for (int i = 2100; i < 2500; ++i) {
        reach.attempt.samples.push_back(reach.attempt.samples[1100]);
        reach.attempt.samples.back().time = i * kTick;
    }
    EXPECT_NEAR(reach.value("movement_time"), 2.1 - (1.3 + rise()), 2 * kTick);
}

TEST(Measures, SayWhyTheyAreMissing) {
    Reach slow;
    for (MotionSample& s : slow.attempt.samples) s.v_W *= 0.1;
    EXPECT_EQ(slow.take("reaction_time").why, "no movement");
    EXPECT_TRUE(std::isnan(slow.value("path_length")));
    const Reach cut(0, 0.55);  // the states of the movement end at the peak
    EXPECT_EQ(cut.take("movement_time").why, "the movement was not over when its states ended");
    EXPECT_NEAR(cut.value("reaction_time"), 0.3 + rise(), kTick);
    EXPECT_EQ(cut.take("initial_direction").why, "");
    Reach resting;
    for (MotionSample& s : resting.attempt.samples) s.v_W.setZero();
    EXPECT_EQ(resting.take("peak_speed").why, "no movement");
    Reach early;
    early.phases.during = {3};
    EXPECT_EQ(early.take("peak_speed").why, "its states were not reached");
    Reach moving;
    for (MotionSample& s : moving.attempt.samples) s.phase = s.time < 1.5 ? 1 : 2;
    EXPECT_EQ(moving.take("peak_speed").why, "the movement began before its states");
    Reach gap;
    gap.attempt.samples[1500].continues = false;
    EXPECT_EQ(gap.take("peak_speed").why, "ticks are missing, or the session was paused");
    EXPECT_EQ(gap.take("grip_onset").why, "no lift");
    rows::LiftRow lift;
    lift.mark = "not lifted";
    gap.attempt.lift = &lift;
    EXPECT_EQ(gap.take("safety_margin").why, "lift: not lifted");
    EXPECT_EQ(gap.take("grip_latency").why, "no load step");
}

/// A reach in which the hand is pushed aside, and then swings back beyond the line, by these
/// distances [m].
Reach pushed_aside(double aside, double back) {
    Reach reach;
    for (MotionSample& s : reach.attempt.samples) {
        const double u = std::clamp((s.time - 1.3) / 0.5, 0.0, 1.0);
        s.p_W.y() = u < 0.5 ? aside * std::sin(2 * std::numbers::pi * u)
                            : back * std::sin(2 * std::numbers::pi * u);
    }
    return reach;
}

TEST(Measures, LateralDeviationIsThatOfTheFirstStrokeWhateverTheSwingBack) {
    const Reach reach = pushed_aside(-0.02, -0.05);
    EXPECT_NEAR(reach.value("lateral_deviation"), -0.02, 1e-5);
    EXPECT_NEAR(reach.value("largest_lateral_deviation"), 0.05, 1e-5);
    EXPECT_NEAR(reach.value("early_lateral_deviation"),
                -0.02 * std::sin(2 * std::numbers::pi * (rise() + 0.15) / 0.5), 3e-4);
    // shaking by less than 2 mm before the push does not count as a reversal
    Reach shaking = pushed_aside(0.02, 0.02);
    for (MotionSample& s : shaking.attempt.samples) s.p_W.y() -= 9e-4 * std::sin(300 * s.time);
    EXPECT_NEAR(shaking.value("lateral_deviation"), 0.02, 1.1e-3);
}

TEST(Measures, PeakSpeedIsThatOfTheFirstStrokeThoughACorrectionIsFaster) {
    Reach reach;  // a correction with a speed of 0.6 m/s follows 0.2 s later
    for (size_t i = 2000; i < 2100; ++i) reach.attempt.samples[i].v_W = {0.6, 0, 0};
    EXPECT_NEAR(reach.value("peak_speed"), 0.375, 1e-12);
    EXPECT_NEAR(reach.value("reaction_time"), 0.3 + rise(), kTick);
    // the peak speed is still that of the reach if the hand twitches by 2 mm before it
    Reach twitching;
    for (size_t i = 1100; i < 1120; ++i) twitching.attempt.samples[i].v_W = {0.2, 0, 0};
    EXPECT_NEAR(twitching.value("peak_speed"), 0.375, 1e-12);
    EXPECT_NEAR(twitching.value("reaction_time"), 0.3 + rise(), kTick);
    // nor does the peak speed change if the hand is still returning when the state begins
    Reach coming;
    for (size_t i = 1000; i < 1100; ++i)
        coming.attempt.samples[i].v_W = {-0.3 * (1 - (static_cast<double>(i) - 1000) / 100), 0, 0};
    EXPECT_NEAR(coming.value("peak_speed"), 0.375, 1e-12);
    EXPECT_NEAR(coming.value("reaction_time"), 0.3 + rise(), kTick);
}

TEST(Measures, AreLeftOutWhereTheyWouldBeNonsense) {
    // walls that catch a hand beside its line throw it onto the line faster than it then reaches
    Reach thrown;
    thrown.attempt.plan.channel = 1;
    thrown.attempt.plan.field_share = kUnmeasured;
    const double index = thrown.value("adaptation_index");
    for (size_t i = 1010; i < 1040; ++i) {
        thrown.attempt.samples[i].v_W = {0, 0.9, 0};
        thrown.attempt.samples[i].f_W = {0, -20, 0};
    }
    EXPECT_NEAR(thrown.value("adaptation_index"), index, 1e-12);
    Reach half;
    half.attempt.plan.channel = 1;
    half.attempt.plan.to_W = {0.25, 0, 0};
    EXPECT_EQ(half.take("adaptation_index").why,
              "the movement covered 39 % of the line, less than 50 %");
    EXPECT_TRUE(std::isnan(half.value("adaptation_index")));
    EXPECT_EQ(half.take("channel_force").why, "");
    Reach weak;
    weak.attempt.plan.channel = 1;
    weak.attempt.plan.ideal *= 0.01;
    EXPECT_EQ(weak.take("adaptation_index").why, "the ideal force was 0.04 N, less than 0.05");
    Reach wild;
    wild.attempt.plan.channel = 1;
    for (MotionSample& s : wild.attempt.samples) s.f_W = {0, -60 * s.v_W.x(), 0};
    const MeasuredValues of = wild.take("adaptation_index");
    EXPECT_TRUE(std::isnan(of.values[0]));
    EXPECT_NEAR(of.values[1], 4, 1e-9);
    EXPECT_EQ(of.why, "adaptation_index would be 4, outside -3 to 3");
    Reach still;
    still.attempt.plan.to_W = {2, 0, 0};
    EXPECT_EQ(still.take("reaction_time").why,
              "the movement covered 5 % of the way, less than 10 %");
}

TEST(Measures, OfAThousandSpoiltReachesMakeSenseOrSayWhyTheyAreMissing) {
    expect_sense_of_spoilt(1000);
}

TEST(Measures, GripLatencyIsFromTheStepToTheAnswer) {
    Reach held;
    held.phases.step = 2;
    EXPECT_EQ(held.take("grip_latency").why, "grip did not respond");
    for (size_t i = 0; i < held.attempt.samples.size(); ++i) {
        MotionSample& s = held.attempt.samples[i];
        if (i < 1000) s.grip += i % 2 == 0 ? 0.01 : -0.01;
        if (i >= 1030 && i < 1035) s.grip = 3;  // too short to count as a response
        if (i >= 1080) s.grip = 2.005 + 0.01 * static_cast<double>(i - 1080);
    }
    // 0.05 N above the mean, reached after five ticks
    EXPECT_NEAR(held.value("grip_latency"), 0.085, kTick / 2);
    for (size_t i = 1085; i < held.attempt.samples.size(); ++i) held.attempt.samples[i].phase = 3;
    EXPECT_EQ(held.take("grip_latency").why, "grip did not respond");  // grip rises too late
}

TEST(Measures, SpectralArcLengthIsThatOfItsAuthors) {
    // values computed with the authors' Python code (siva82kb/SPARC), for one and for two
    // bell-shaped profiles that last one second each
    std::vector<double> bell, two;
    for (int i = 0; i < 1000; ++i) {
        const double t = i * kTick;
        bell.push_back(std::exp(-5 * std::pow(2 * t - 1, 2)));
        two.push_back(std::exp(-40 * std::pow(t - 0.3, 2)) + std::exp(-40 * std::pow(t - 0.7, 2)));
    }
    EXPECT_NEAR(spectral_arc_length(bell, kTick), -1.413979710383478, 1e-9);
    EXPECT_NEAR(spectral_arc_length(two, kTick), -1.9192306295354775, 1e-9);
    EXPECT_TRUE(std::isnan(spectral_arc_length({}, kTick)));
}

/// Folder of a session with a task that computes measures of a reach.
struct Session {
    testing::TemporaryFolder folder;
    recording::LogHead head;

    explicit Session(const std::string& measures) {
        folder.write("session.yaml", "");
        folder.write("task.yaml", "measures: [" + measures +
                                      "]\n"
                                      "movement: { of: index, from: a, to: b, during: [reach] }\n");
        folder.write("trial-list.csv",
                     "trial_num,movement_from_x_mm,movement_from_y_mm,movement_from_z_mm,"
                     "movement_to_x_mm,movement_to_y_mm,movement_to_z_mm,movement_axis_x,"
                     "movement_axis_y,movement_axis_z\n1,0,0,0,100,0,0,0,0,1\n");
        head.fingers = {"thumb", "index"};
        head.tick = kTick;
    }
    std::optional<MeasureFinder> finder() const {
        return MeasureFinder::of(recording::SessionFolder::open_tables(folder.path()), head,
                                 {"between trials", "wait", "reach"});
    }
};

TEST(Measures, AreTakenFromTheFramesOfEachAttempt) {
    const Session session("peak_speed, path_length, channel_force");
    std::optional<MeasureFinder> finder = session.finder();
    ASSERT_TRUE(finder);
    const Reach reach;
    frame::Frame frame;
    frame.fingers.resize(2);
    for (const MotionSample& s : reach.attempt.samples) {
        frame.time = Time(std::llround(s.time * 1e9));
        frame.trial = 1;
        frame.task.attempt = 2;
        frame.phase = s.phase;
        frame.fingers[1].p_WH = s.p_W;
        frame.fingers[1].v_WH = s.v_W;
        finder->add(frame);
        ++frame.sequence;
    }
    finder->end_attempt(nullptr);
    finder->end_attempt(nullptr);  // called between trials
    Table trials{{{"trial_num", ""}, {"attempt", ""}}, {{1.0, 1.0}, {1.0, 2.0}}};
    finder->add_to(trials);
    ASSERT_EQ(trials.columns.size(), 2u + 1 + 1 + 3 + 1);
    EXPECT_EQ(trials.columns[2].name, "peak_speed_m_s");
    EXPECT_EQ(trials.columns[3].name, "path_length_mm");
    EXPECT_EQ(trials.columns[6].name, "channel_force_impulse_Ns");
    for (const auto& row : trials.rows) ASSERT_EQ(row.size(), trials.columns.size());
    EXPECT_EQ(std::get<std::string>(trials.rows[0].back()), "not recorded");
    EXPECT_NEAR(std::get<double>(trials.rows[1][2]), 0.375, 1e-12);
    EXPECT_NEAR(std::get<double>(trials.rows[1][3]), 100, 1);
    EXPECT_TRUE(std::isnan(std::get<double>(trials.rows[1][4])));
    EXPECT_EQ(std::get<std::string>(trials.rows[1].back()), "channel_force: no channel");
}

TEST(Measures, AreNoneWhereTheTaskListsNone) {
    EXPECT_FALSE(Session("").finder());
    const Session session("peak_speed");
    session.folder.write("task.yaml", "measures: [");
    EXPECT_FALSE(session.finder());
}

std::string measure_table() {
    std::string out =
        "\n| measure | column | unit | range | meaning | source |\n|---|---|---|---|---|---|\n";
    for (const task::MeasureRow& row : task::kMeasureTable) {
        std::string name = fmt::format("`{}`", row.name);
        std::string source = row.source;
        const std::vector<Table::Column> columns = task::columns_of_measure(row);
        for (size_t i = 0; i < columns.size(); ++i) {
            const Table::Column& c = columns[i];
            out +=
                fmt::format("| {} | `{}` | {} | {:g} to {:g} | {} | {} |\n", name, c.name, c.unit,
                            row.columns[i].least, row.columns[i].most, c.description, source);
            name = source = "";
        }
    }
    return out;
}

/// The text before the table on the page is written by hand.
TEST(Measures, PageHasTheTable) {
    const std::string page = testing::read_file(kPage);
    const std::string title = "\n## Table\n";
    const std::string made = page.substr(0, page.find(title)) + title + measure_table();
    if (std::getenv("DIHAPTIC_RENEW_TABLES") != nullptr) {
        std::ofstream(kPage) << made;
    } else {
        EXPECT_EQ(page, made) << kPage
                              << " says something else than the code. Renew it in the same commit: "
                                 "DIHAPTIC_RENEW_TABLES=1 build/release/src/analysis/analysis_test "
                                 "--gtest_filter='Measures.*'";
    }
    for (const task::MeasureRow& row : task::kMeasureTable)
        EXPECT_NE(page.find(row.name), std::string::npos) << row.name;
}

}  // namespace
}  // namespace dihaptic::analysis::measures_test
