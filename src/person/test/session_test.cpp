// Tests a simulated person in a session: the session is recorded, replays exactly and allocates no
// memory, and the person answers questions.
#include <gtest/gtest.h>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <map>
#include <optional>

#include "base/field_reader.h"
#include "person/test/sitting.h"
#include "session/replay.h"
#include "session/test/allocations.h"

namespace dihaptic::person::session_test {
namespace {

constexpr const char* kShort = R"(  blocks:
    - { name: rotation, kind: perturbed, perturb: rotation, repeats: 3 }
)";

TEST(Session, OfAPersonIsRecordedWithWhoItWasAndReplaysToTheBit) {
    Sitting sitting("rotation-reversal");
    sitting.end_with("  blocks:", kShort);
    session::RunOptions options;
    options.out = sitting.folder.file("sessions");
    const auto run = [&](const std::string& id) {
        session::Plan plan = sitting.plan();
        sit_down(plan, draw_person(Objects::device, plan.seed, id));
        options.participant.id = id;
        return session::run_session(plan, options, kGoOn, {}).folder;
    };
    const std::string first = run("S01");
    EXPECT_TRUE(session::replay_session(first, kGoOn, {}).good());
    Diagnostics diagnostics;
    Traits traits;
    read_fields(traits, read_yaml(first + "/person.yaml"), diagnostics);
    diagnostics.throw_if_errors();
    EXPECT_EQ(traits.slow_learning, draw_person(Objects::device, 1, "S01").slow_learning);
    const auto frames = [](const std::string& folder) {
        return testing::read_file(folder + "/raw.log");
    };
    EXPECT_EQ(frames(first).size(), frames(run("S01")).size());
    EXPECT_NE(frames(first).size(), frames(run("S02")).size());
}

TEST(Session, OfTwoPeopleHasBothWithTheirTraitsAndReplaysToTheBit) {
    Sitting sitting("joint-action-points");
    sitting.end_with("  blocks:", "  blocks: [{ name: carrying }]\n");
    sitting.replace("  rounds:\n    - { name: alone, factors: { people: 1 } }\n", "  rounds:\n");
    const auto run = [&](const std::string& partner) {
        session::Plan plan = sitting.plan();
        EXPECT_TRUE(session::is_for_two(plan));
        sit_down(plan, draw_person(Objects::device, plan.seed, "S01"),
                 draw_person(Objects::device, plan.seed, partner));
        session::RunOptions options;
        options.out = sitting.folder.file("sessions");
        options.participant.id = "S01";
        options.partner.id = partner;
        return session::record(plan, options, kGoOn).folder;
    };
    const std::string folder = run("S02");
    EXPECT_TRUE(session::replay_session(folder, kGoOn, {}).good());
    const auto info = recording::SessionFolder::open(folder).read_info();
    ASSERT_TRUE(info.partner);
    EXPECT_EQ(info.partner->id, "S02");
    EXPECT_EQ(CsvFile(folder + "/trials.csv").text(0, "partner"), "S02");
    const Node node = read_yaml(folder + "/person.yaml");
    ASSERT_NE(node.find("partner"), nullptr);
    EXPECT_EQ(node.find("partner")->find("id")->scalar, "S02");
    // each hand is moved by a person of its own: with another partner, only the start of the second
    // hand's movement differs
    const auto first_moves = [](const std::string& session) {
        std::array<double, 2> out{-1, -1};
        recording::RawLogReader log(session + "/raw.log");
        while (const frame::Frame* frame = log.next()) {
            for (size_t i = 0; i < 2; ++i) {
                if (out[i] < 0 && frame->fingers[i].v_WH.norm() > 0.05)
                    out[i] = seconds(frame->time);
            }
            if (out[0] >= 0 && out[1] >= 0) break;
        }
        return out;
    };
    const auto one = first_moves(folder), other = first_moves(run("S03"));
    EXPECT_EQ(one[0], other[0]);
    EXPECT_NE(one[1], other[1]);
    EXPECT_NE(one[0], one[1]);
}

TEST(Session, OfTwoHandsMovesTheSecondAsTheFileSaysAndReplaysToTheBit) {
    Sitting sitting("pass-block");
    sitting.end_with("  blocks:", "  blocks: [{ name: passing }]\n");
    session::Plan plan = sitting.plan();
    sit_down(plan, draw_person(Objects::device, plan.seed, "S01"));
    session::RunOptions options;
    options.out = sitting.folder.file("sessions");
    const std::string folder = session::record(plan, options, kGoOn).folder;
    EXPECT_TRUE(session::replay_session(folder, kGoOn, {}).good());
    const CsvFile trials(folder + "/trials.csv");
    ASSERT_GE(trials.rows(), 2u);
    for (size_t i = 0; i < trials.rows(); ++i) EXPECT_EQ(trials.text(i, "outcome"), "passed");
}

TEST(Session, OfTwoHandsHasThePersonsOwnFingersFirst) {
    Sitting sitting("pass-block");
    sitting.replace("{ name: right_thumb, side: [-1, 0, 0] }",
                    "{ name: right_thumb, side: [-1, 0, 0], aperture_mm: 90 }");
    session::Plan plan = sitting.plan();
    try {
        sit_down(plan, draw_person(Objects::device, plan.seed, "S01"));
        FAIL();
    } catch (const Error& error) {
        EXPECT_NE(std::string(error.what()).find("right_thumb: belongs to another hand"),
                  std::string::npos)
            << error.what();
        EXPECT_GT(error.problems().front().place.line, 0);
    }
}

TEST(Session, ThatIsReadWhileItRunsHasTheTablesOfItsLog) {
    for (const char* name : {"rotation-reversal", "grip-by-sight"}) {
        Sitting sitting(name);
        sitting.end_with("  blocks:", "  blocks: [{ name: some, repeats: 2 }]\n");
        session::Plan plan = sitting.plan();
        sit_down(plan, draw_person(Objects::device, plan.seed, "sim-001"));
        session::RunOptions options;
        options.out = sitting.folder.file("logged");
        const session::Recorded logged = session::record(plan, options, kGoOn);

        options.out = sitting.folder.file("read");
        options.keep_log = false;
        const session::Recorded read = session::record(plan, options, kGoOn);
        EXPECT_EQ(read.ticks, logged.ticks);
        EXPECT_FALSE(std::filesystem::exists(read.folder + "/raw.log"));
        int tables = 0;
        for (const char* table :
             {"trials.csv", "phases.csv", "events.csv", "episodes.csv", "lifts.csv"}) {
            if (!std::filesystem::exists(logged.folder + "/" + table)) continue;
            ++tables;
            EXPECT_EQ(testing::read_file(read.folder + "/" + table),
                      testing::read_file(logged.folder + "/" + table))
                << table;
        }
        EXPECT_GE(tables, 4);
    }
}

TEST(Session, OfShippedGripsGoesOnOnceTheHandIsAway) {
    const std::array<std::pair<const char*, const char*>, 3> shipped{
        {{"grip-by-sight", "away"}, {"grip-and-lift", "away"}, {"visual-scaling", "more"}}};
    for (const auto& [name, state] : shipped) {
        Sitting sitting(name);
        if (std::string(name) == "visual-scaling") {
            sitting.end_with("  procedures:",
                             "  blocks: [{ name: some, kind: perturbed, perturb: more along x, "
                             "repeats: 2 }]\n");
        } else {
            sitting.end_with("  blocks:", "  blocks: [{ name: some, repeats: 1 }]\n");
        }
        session::Plan plan = sitting.plan();
        sit_down(plan, median_person(Objects::device));
        const auto phases = plan.task->phases();
        std::map<int, double> spent;  // for each trial, time spent in the last state [s]
        run_trials(plan, [&, last = std::string(state)](const frame::Frame& frame) {
            const std::string& phase = phases[static_cast<size_t>(frame.phase)];
            if (phase == last || (phase == "less" && last == "more"))
                spent[frame.trial] += plan.settings.tick();
        });
        ASSERT_FALSE(spent.empty()) << name;
        for (const auto& [trial, time] : spent) EXPECT_LT(time, 3.5) << name << " " << trial;
    }
}

TEST(Session, OfAPersonAllocatesNothingInTheTick) {
    DIHAPTIC_NEEDS_ALLOCATION_GUARD();
    for (const char* name : {"rotation-reversal", "directional-mass", "joint-action-points"}) {
        SCOPED_TRACE(name);
        Sitting sitting(name);
        sitting.end_with("  blocks:", "  blocks: [{ name: some, repeats: 2 }]\n");
        session::Plan plan = sitting.plan();
        sit_down(plan, draw_person(Objects::device, plan.seed, "S01"));
        session::expect_no_allocation(plan, 150);
    }
}

TEST(Session, GoesOnWithAPersonWhoGivesUpOrHesitates) {
    Sitting sitting("rotation-reversal");
    sitting.end_with("  blocks:", "  blocks: [{ name: some, repeats: 6 }]\n");
    session::Plan plan = sitting.plan();
    Traits traits = median_person(Objects::device);
    traits.give_up_rate = 0.5;
    traits.hesitation_rate = 0.5;
    sit_down(plan, traits);
    int done = 0;
    run_trials(plan, [&](const frame::Frame& frame) { done += frame.task.outcome >= 0 ? 1 : 0; });
    EXPECT_GE(done, 6);
}

/// The answers, with the keys y and n, to "Was it shown larger than it felt?" after reaches that
/// are displayed scaled.
std::vector<std::string> answers(double scale, const Traits& traits, int trials) {
    Sitting sitting("rotation-reversal");
    sitting.end_with("  perturbations:", fmt::format(R"(  perturbations:
    - name: scaling
      visual: {{ moves: [proxies], about: start, scale: [1, {}, 1] }}
  states:
    - name: go to the start
      show: [start]
      perturbed: no
      exits: [{{ when: inside, region: start, hold_s: 0.2, to: reach }}]
      simulated_hand: [{{ duration_s: 0.5, reach: start }}]
    - name: reach
      show: [target]
      exits: [{{ when: time, after_s: 1.5, to: ask }}]
      simulated_hand: [{{ duration_s: 0.5, reach: target }}]
    - name: ask
      exits:
        - {{ when: key, key: y, outcome: larger }}
        - {{ when: key, key: n, outcome: smaller }}
  blocks: [{{ name: all, kind: perturbed, perturb: scaling, repeats: {} }}]
)",
                                                     scale, trials));
    session::Plan plan = sitting.plan();
    sit_down(plan, traits);
    std::vector<std::string> out;
    run_trials(plan, [&](const frame::Frame& frame) {
        if (frame.task.outcome >= 0)
            out.push_back(plan.task->outcomes[static_cast<size_t>(frame.task.outcome)].name);
    });
    return out;
}

TEST(Session, AnswersByThePsychometricFunction) {
    Traits traits = median_person(Objects::device);
    traits.answer_bias = 0;
    traits.answer_sd = 0.1;
    traits.answer_lapse = 0.02;
    constexpr int kTrials = 60;
    for (const double level : {-0.3, 0.1, 0.3}) {
        const auto given = answers(std::exp(level), traits, kTrials);
        ASSERT_EQ(given.size(), size_t{kTrials});
        const double share =
            static_cast<double>(std::count(given.begin(), given.end(), "larger")) / kTrials;
        const double p = traits.answers().probability(level);
        EXPECT_NEAR(share, p, 3 * std::sqrt(p * (1 - p) / kTrials) + 0.01) << level;
    }
}

TEST(Session, OfAPersonFindsThresholdsOfWhatIsShown) {
    Sitting sitting("visual-scaling");
    sitting.end_with("  redo:",
                     "  blocks:\n    - { name: thresholds, kind: perturbed, procedures: "
                     "[more along x, less along x] }\n");
    session::Plan plan = sitting.plan(3);
    sit_down(plan, draw_person(Objects::device, plan.seed, "S01"));
    std::vector<double> shares;
    int right = 0;
    double share = 0;
    run_trials(plan, [&](const frame::Frame& frame) {
        if (frame.task.share != 0) share = frame.task.share;
        if (frame.task.outcome < 0) return;
        const auto& trial = plan.task->trials[static_cast<size_t>(frame.trial) - 1];
        const std::string& said = plan.task->outcomes[static_cast<size_t>(frame.task.outcome)].name;
        if (said != "more" && said != "less") return;
        shares.push_back(share);
        right += said == plan.task->task.procedures[static_cast<size_t>(trial.procedure)].yes;
    });
    ASSERT_EQ(shares.size(), 50u);
    // staircases start where the scaling is obvious, and settle where 80 % of the answers are right
    EXPECT_EQ(shares.front(), 0.8);
    EXPECT_LT(*std::min_element(shares.begin(), shares.end()), 0.5);
    EXPECT_GT(right, 32);
    EXPECT_LT(right, 48);
}

}  // namespace
}  // namespace dihaptic::person::session_test
