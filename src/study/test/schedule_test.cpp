#include "study/schedule.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "testing/files.h"

namespace dihaptic::study {
namespace {

const double kNow = seconds_of("2026-03-29T12:00:00+02:00");

StudyFile two_days() {
    StudyFile out;
    out.sessions.resize(2);
    out.sessions[0].name = "day1";
    out.sessions[1].name = "day2";
    out.sessions[1].least_gap = 20;
    out.sessions[1].most_gap = 28;
    return out;
}

Visit complete(size_t session, const char* started) {
    return {session, "there", seconds_of(started), true};
}

TEST(Seconds, AreThoseOfATimeInAnyZone) {
    EXPECT_EQ(seconds_of("1970-01-02T00:00:00+00:00"), 86400);
    // daylight saving time began between the two times
    EXPECT_EQ(seconds_of("2026-03-29T12:00:00+02:00") - seconds_of("2026-03-28T12:00:00+01:00"),
              23 * 3600);
    EXPECT_EQ(seconds_of("2026-12-31T23:30:00-05:00"), seconds_of("2027-01-01T04:30:00+00:00"));
    for (const char* text : {"yesterday", "", "2026-03-28T12:00:00Z", "2026-03-28 12:00:00+01:00",
                             "2026-13-28T12:00:00+01:00"})
        EXPECT_TRUE(std::isnan(seconds_of(text))) << text;
}

TEST(Next, BeginsWithTheFirstSession) {
    const Next next = next_for(two_days(), {}, kNow);
    EXPECT_EQ(next.act, Act::begin);
    EXPECT_EQ(next.session, 0U);
    EXPECT_TRUE(next.against.empty());
}

TEST(Next, SaysByHowMuchASessionIsTooEarlyOrTooLate) {
    const auto early = next_for(two_days(), {complete(0, "2026-03-29T09:00:00+02:00")}, kNow);
    ASSERT_EQ(early.against.size(), 1U);
    EXPECT_NE(early.against[0].find("17.0 h too early"), std::string::npos) << early.against[0];
    const auto good = next_for(two_days(), {complete(0, "2026-03-28T12:00:00+01:00")}, kNow);
    EXPECT_EQ(good.session, 1U);
    EXPECT_TRUE(good.against.empty());
    const auto late = next_for(two_days(), {complete(0, "2026-03-27T12:00:00+01:00")}, kNow);
    ASSERT_EQ(late.against.size(), 1U);
    EXPECT_NE(late.against[0].find("19.0 h too late"), std::string::npos) << late.against[0];
}

TEST(Next, ResumesASessionThatWasInterruptedAShortTimeAgo) {
    const Visit visit{0,  "broken", seconds_of("2026-03-29T11:00:00+02:00"), false, false, false,
                      10, 40};
    const Next next = next_for(two_days(), {visit}, kNow);
    EXPECT_EQ(next.act, Act::resume);
    EXPECT_EQ(next.folder, "broken");
}

TEST(Next, BeginsAnOldInterruptedSessionAnewUnlessEnoughOfItIsDone) {
    const Visit visit{0,  "broken", seconds_of("2026-03-28T12:00:00+01:00"), false, false, false,
                      36, 40};
    StudyFile study = two_days();
    const Next again = next_for(study, {visit}, kNow);
    EXPECT_EQ(again.act, Act::begin);
    EXPECT_EQ(again.session, 0U);
    EXPECT_NE(again.note.find("36 of 40"), std::string::npos) << again.note;
    study.resuming.complete = 0.9;
    EXPECT_EQ(next_for(study, {visit}, kNow).session, 1U);
}

TEST(Counted, IsTheFirstCompleteRecordingOrTheLastWithEnoughTrials) {
    StudyFile study = two_days();
    const auto broken = [](const char* folder, size_t done, bool running = false) {
        return Visit{0,    folder, seconds_of("2026-03-29T11:00:00+02:00"), false, running, false,
                     done, 10};
    };
    EXPECT_EQ(counted(study, {}, 0), nullptr);
    EXPECT_EQ(counted(study, {broken("first", 9)}, 0), nullptr);
    study.resuming.complete = 0.9;
    const std::vector<Visit> visits{broken("first", 9), broken("second", 10)};
    ASSERT_NE(counted(study, visits, 0), nullptr);
    EXPECT_EQ(counted(study, visits, 0)->folder, "second");
    EXPECT_EQ(counted(study, {broken("first", 9), broken("second", 3)}, 0), nullptr);
    EXPECT_EQ(counted(study, {broken("first", 10, true)}, 0), nullptr);
    const std::vector<Visit> done{broken("first", 9), complete(0, "2026-03-29T09:00:00+02:00"),
                                  broken("third", 10)};
    EXPECT_EQ(counted(study, done, 0)->folder, "there");
    EXPECT_EQ(counted(study, done, 1), nullptr);
}

TEST(Next, IsNotASessionThatIsRunning) {
    const Visit visit{0, "busy", kNow - 60, false, true, false, 10, 40};
    const Next next = next_for(two_days(), {visit}, kNow);
    ASSERT_EQ(next.against.size(), 1U);
    EXPECT_EQ(next.against[0], "busy is running now");
}

TEST(Next, EndsWithTheLastSession) {
    const std::vector<Visit> visits{complete(0, "2026-03-27T12:00:00+01:00"),
                                    complete(1, "2026-03-28T12:00:00+01:00")};
    EXPECT_EQ(next_for(two_days(), visits, kNow).act, Act::none);
}

class Needs : public ::testing::Test {
  protected:
    void SetUp() override {
        std::ofstream(file_)
            << "trial_num,attempt,outcome,time_s\n1,1,miss,9\n1,2,hit,1\n2,1,hit,2\n3,1,"
               "miss,\n";
    }
    testing::TemporaryFolder folder_;
    std::string file_ = folder_.file("trials.csv");
};

TEST_F(Needs, AreSharesAndMeansOfLastAttempts) {
    EXPECT_EQ(unmet({"outcome", "hit", 0.66, {}, {}}, file_), "");
    EXPECT_NE(unmet({"outcome", "hit", 0.7, {}, {}}, file_).find("0.6667 in 3 trials"),
              std::string::npos);
    EXPECT_EQ(unmet({"time_s", "", {}, 1.5, {}}, file_), "");
    EXPECT_NE(unmet({"time_s", "", {}, 1.4, {}}, file_).find("1.5 in 2 trials"), std::string::npos);
}

TEST_F(Needs, OfAColumnThatIsNotThereAreNotMet) {
    EXPECT_NE(unmet({"speed", "", 1, {}, {}}, file_).find("no column 'speed'"), std::string::npos);
}

}  // namespace
}  // namespace dihaptic::study
