// Tests what simulated people do about a jump of the target or of the cursor within a reach, and
// what they show of an adaptation when they do not see their hand.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "base/unit.h"
#include "person/test/sitting.h"

namespace dihaptic::person::online_test {
namespace {

constexpr int kCorrected = 3;  // the state of experiments/online-corrections.yaml with the jump

struct Corrected {
    double latency = -1;  ///< from the jump until the hand moves sideways at 20 mm/s [s]
    double goes = 0;      ///< sideways velocity at that time [m/s]
    double aside = 0;     ///< where the hand ends, to the right [m]
};

/// The second of two trials in one condition of experiments/online-corrections.yaml, by a person
/// without noise.
Corrected corrected(const std::string& condition) {
    Sitting sitting("online-corrections");
    sitting.end_with("  blocks:",
                     "  blocks:\n    - { name: jumps, kind: perturbed, perturb: jump, "
                     "conditions: [" +
                         condition + "], repeats: 2 }\n");
    session::Plan plan = sitting.plan();
    sit_down(plan, median_person(Objects::device));
    Corrected out;
    double jumped = -1;
    run_trials(plan, [&](const frame::Frame& frame) {
        if (frame.trial != 2 || frame.phase != kCorrected) return;
        const double now = seconds(frame.time);
        if (jumped < 0) jumped = now;
        const frame::FingerFrame& finger = frame.fingers[0];
        if (out.latency < 0 && std::abs(finger.v_WH.x()) > 0.02) {
            out.latency = now - jumped;
            out.goes = finger.v_WH.x();
        }
        out.aside = finger.p_WH.x();
    });
    return out;
}

TEST(Online, JumpsOfTargetAndCursorAreCorrectedWithinTheReach) {
    EXPECT_EQ(corrected("no jump").latency, -1);
    // people begin after 0.12 to 0.16 s (Saunders and Knill 2003, 2005; Sarlegna et al. 2003)
    const Corrected target = corrected("target right");
    EXPECT_GT(target.latency, 0.11);
    EXPECT_LT(target.latency, 0.2);
    EXPECT_GT(target.goes, 0);
    EXPECT_NEAR(target.aside, 0.02, 5e-3);
    // a hand that is shown too far to the right moves to the left
    const Corrected cursor = corrected("cursor right");
    EXPECT_NEAR(cursor.latency, target.latency, 0.02);
    EXPECT_LT(cursor.goes, 0);
    EXPECT_NEAR(cursor.aside, -0.02, 5e-3);
}

/// The angles of thirty reaches with a rotated cursor and of one in a state of its own, at 50 mm
/// [degrees]. `seen_later`: whether the cursor, hidden at first, appears in all of these reaches.
std::vector<double> angles_with_a_probe(const Traits& traits, bool seen_later) {
    Sitting sitting("rotation-reversal");
    sitting.end_with("  states:", fmt::format(R"(  conditions:
    - {{ name: train, factors: {{ seen: 1 }} }}
    - {{ name: probe, factors: {{ seen: 0 }} }}
  states:
    - name: home
      perturbed: no
      show: [start]
      exits:
        - {{ when: "inside(hand, start) and seen == 1", hold_s: 0.3, to: reach }}
        - {{ when: "inside(hand, start) and seen == 0", hold_s: 0.3, to: reach unseen }}
        - {{ when: time, after_s: 20, outcome: no start }}
      simulated_hand: [{{ duration_s: 0.6, reach: start }}]
    - name: reach
      show: {{ targets: [target], cursor: {} }}
      exits: [{{ when: time, after_s: {}, to: rest }}]
      simulated_hand: [{{ duration_s: 0.7, reach: target }}]
    - name: rest
      show: [target]
      exits: [{{ when: time, after_s: 1, outcome: reached }}]
    - name: reach unseen
      show: {{ targets: [target], cursor: no }}
      exits: [{{ when: time, after_s: 1.5, outcome: reached }}]
      simulated_hand: [{{ duration_s: 0.7, reach: target }}]
  blocks:
    - {{ name: rotation, kind: perturbed, perturb: rotation, conditions: [train], repeats: 30 }}
    - {{ name: unseen, kind: perturbed, perturb: rotation, conditions: [probe], repeats: 1 }}
)",
                                              seen_later ? "no" : "yes", seen_later ? 0.5 : 1.0));
    session::Plan plan = sitting.plan();
    sit_down(plan, traits);
    std::vector<double> angle(31, NAN);  // by trial
    run_trials(plan, [&](const frame::Frame& frame) {
        if (frame.trial < 1 || frame.phase < 2) return;
        double& out = angle[static_cast<size_t>(frame.trial - 1)];
        const Vec3 way = frame.fingers[0].p_WH - Vec3(0, -0.04, 0.12);
        if (std::isnan(out) && way.norm() > 0.05) out = std::atan2(way.x(), way.y()) / kDegree;
    });
    return angle;
}

TEST(Online, AShareOfWhatWasLearnedShowsInReachesWithoutACursor) {
    Traits traits = median_person(Objects::device);
    traits.online_correction = 0;
    for (const double share : {1.0, 0.6}) {
        traits.unseen_share = share;
        const auto angle = angles_with_a_probe(traits, false);
        EXPECT_GT(angle[29], 12);
        EXPECT_NEAR(angle[30], share * angle[29], 2) << share;
    }
}

TEST(Online, AllOfItShowsWhereTheCursorAppearsLaterInTheReach) {
    Traits traits = median_person(Objects::device);
    traits.online_correction = 0;
    traits.unseen_share = 0.3;
    const auto angle = angles_with_a_probe(traits, true);
    EXPECT_GT(angle[29], 12);
    EXPECT_NEAR(angle[30], 0.3 * angle[29], 2);
}

}  // namespace
}  // namespace dihaptic::person::online_test
