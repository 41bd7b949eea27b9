// Tests that a rehearsal warns if a task demands something for which simulated people have no
// model.
#include "person/simulated_limits.h"

#include <gtest/gtest.h>

#include "person/test/sitting.h"

namespace dihaptic::person::limits_test {
namespace {

/// The warnings for the shipped rotation experiment with different perturbations, states and
/// blocks.
std::vector<Problem> limits(const std::string& rest) {
    Sitting sitting("rotation-reversal");
    sitting.end_with("  perturbations:", rest);
    return simulated_limits(*sitting.plan().task);
}

std::string task(const std::string& perturbation, const std::string& exits,
                 const std::string& hand = "duration_s: 0.5, reach: target") {
    return "  perturbations:\n    - { name: changed, " + perturbation +
           " }\n  states:\n    - name: reach\n      show: [target]\n      exits: [{ when: time, "
           "after_s: 1, to: ask }]\n      simulated_hand: [{ " +
           hand + " }]\n    - name: ask\n      exits:\n" + exits +
           "  blocks: [{ name: all, kind: perturbed, perturb: changed, repeats: 2 }]\n";
}

constexpr const char* kScaling = "visual: { moves: [proxies], about: start, scale: [1, 1.2, 1] }";
constexpr const char* kCurl = "field: { kind: curl, on: index, axis: [0, 0, 1], damping_Ns_m: 13 }";
constexpr const char* kEnd = "        - { when: time, after_s: 1, outcome: done }\n";
constexpr const char* kTwo =
    "        - { when: key, key: y, outcome: yes }\n        - { when: key, key: n, outcome: no }\n";
constexpr const char* kThree = "        - { when: key, key: \"3\", outcome: rated 3 }\n";

TEST(Limits, SayThatRatingsAreArbitraryEvenWhereLengthsAreScaled) {
    const auto found = limits(task(kScaling, std::string(kTwo) + kThree));
    ASSERT_EQ(found.size(), 1u);
    EXPECT_NE(found[0].text().find("ask: asks for one of 3 keys"), std::string::npos)
        << found[0].text();
    EXPECT_NE(found[0].text().find("arbitrary"), std::string::npos);
    EXPECT_GT(found[0].place.line, 0);
}

TEST(Limits, SayThatAnswersAboutForcesAreArbitraryButNotThoseAboutLengths) {
    EXPECT_TRUE(limits(task(kScaling, kTwo)).empty());
    const auto found = limits(task(kCurl, kTwo));
    ASSERT_EQ(found.size(), 1u);
    EXPECT_NE(found[0].text().find("arbitrary"), std::string::npos) << found[0].text();
}

TEST(Limits, SayThatFieldsAreLearnedInReachesOnly) {
    EXPECT_TRUE(limits(task(kCurl, kEnd)).empty());
    const auto found = limits(task(kCurl, kEnd, "duration_s: 0.5, move_mm: [0, 100, 0]"));
    ASSERT_EQ(found.size(), 1u);
    EXPECT_NE(found[0].text().find("changed: is a force field"), std::string::npos)
        << found[0].text();
}

TEST(Limits, SayThatLearningTakesNoNoticeOfADelay) {
    const auto found = limits(task(
        "visual: { moves: [proxies], about: start, axis: [0, 0, 1], angle_deg: 30, delay_ms: 200 }",
        kEnd));
    ASSERT_EQ(found.size(), 1u);
    EXPECT_NE(found[0].text().find("changed: is shown late"), std::string::npos) << found[0].text();
}

TEST(Limits, SayOnceThatForcesOfMotorsAreNotMatched) {
    const auto found = simulated_limits(*Sitting("force-matching").plan().task);
    ASSERT_EQ(found.size(), 1u);
    EXPECT_NE(found[0].text().find("target: pushes with a motor"), std::string::npos)
        << found[0].text();
}

}  // namespace
}  // namespace dihaptic::person::limits_test
