// Tasks: the order of trials, states and what ends them, perturbations in the file, sessions that
// go on, and every mistake that a file can have.
#include "experiment/task.h"

#include <gtest/gtest.h>

#include <map>
#include <numbers>
#include <set>

#include "analysis/recovery.h"
#include "experiment/replay.h"
#include "experiment/session_run.h"
#include "experiment/task_director.h"
#include "experiment/task_hand.h"
#include "recording/raw_log.h"
#include "testing/allocation_guard.h"
#include "testing/files.h"

namespace dihaptic::experiment {
namespace {

namespace fs = std::filesystem;

const std::atomic<bool> kGoOn{false};

const char* const kScene = R"(bodies:
  - { name: table, shape: box, size_mm: [600, 400, 50], position_mm: [0, 0, -25], fixed: yes }
  - { name: block, shape: box, size_mm: [40, 40, 40], mass_g: 100, position_mm: [0, 0, 20] }
fingers:
  - { name: index, shape: sphere, radius_mm: 6, mass_g: 1 }
)";

/// Reaches of 50 mm, a rotation, a clamp, a channel; an exit of each kind that needs no object.
const char* const kReaches = R"(title: Reaches
scene: scene.yaml
hand: { centre_mm: [0, 0, 120] }
task:
  regions:
    - { name: start, position_mm: [0, 0, 120], radius_mm: 6 }
    - { name: target, position_mm: [50, 0, 120], radius_mm: 6 }
    - { name: shell, position_mm: [0, 0, 120], radius_mm: 45 }
  perturbations:
    - name: rotation
      visual: { moves: [proxies], about: start, axis: [0, 0, 1], angle_deg: 30 }
    - name: clamp
      visual: { moves: [proxies], about: start, toward: target }
    - name: channel
      field: { kind: channel, on: index, from: start, to: target, stiffness_N_m: 1000, damping_Ns_m: 5 }
  states:
    - name: home
      show: [start]
      perturbed: no
      message: Go home
      exits:
        - { when: inside, region: start, hold_s: 0.2, to: reach }
        - { when: time, hold_s: 5, outcome: lost, redo: yes }
      hand: [{ duration_s: 0.2, reach: start }]
    - name: reach
      show: [target]
      marker: 7
      exits:
        - { when: outside, region: shell, outcome: reached, feedback: Good }
        - { when: time, hold_s: 1, outcome: too slow, redo: yes }
      hand: [{ duration_s: 0.2, reach: target }]
  reach: { from: start, to: target, during: reach, distance_mm: 30, axis: [0, 0, 1] }
  conditions:
    - name: right
    - name: far
      regions: [{ name: target, position_mm: [0, 50, 120], radius_mm: 6 }]
  redo: next
  blocks:
    - { name: before, kind: baseline, repeats: 1 }
    - { name: turned, kind: perturbed, perturb: rotation, repeats: 2, ramp: 2, insert: [{ kind: catch, count: 1 }] }
    - { name: clamped, kind: error_clamp, perturb: clamp, repeats: 1, order: sequential }
)";

struct Files {
    testing::TemporaryFolder folder;
    std::string scene = kScene;
    std::string experiment = kReaches;

    Files() = default;
    void replace(const std::string& what, const std::string& by) {
        const size_t at = experiment.find(what);
        ASSERT_NE(at, std::string::npos) << what;
        experiment.replace(at, what.size(), by);
    }
    Request request(uint64_t seed = 1, const std::string& participant = "S01") {
        folder.write("scene.yaml", scene);
        Request request;
        request.file = folder.write("experiment.yaml", experiment);
        request.seed = seed;
        request.participant = participant;
        return request;
    }
    RunResult run(const Plan& plan, const std::atomic<bool>& stop = kGoOn) {
        RunOptions options;
        options.out = folder.file("sessions");
        return run_session(plan, options, stop, {});
    }
};

/// A column of a session's trials.csv.
std::vector<std::string> column(const std::string& session, const std::string& name) {
    const auto rows = read_csv(session + "/trials.csv");
    const auto at = std::find(rows[0].begin(), rows[0].end(), name) - rows[0].begin();
    std::vector<std::string> out;
    for (size_t i = 1; i < rows.size(); ++i) out.push_back(rows[i].at(static_cast<size_t>(at)));
    return out;
}

analysis::SessionFigures finish(const RunResult& result) {
    return analysis::finish_session(recording::SessionFolder::open(result.folder), result.info, {});
}

TEST(Order, ALatinSquarePutsEachItemInEachPlaceAndAfterEachOtherEquallyOften) {
    Random random(1, "test");
    for (const int n : {2, 3, 4, 5, 8}) {
        const int rows = n % 2 == 0 ? n : 2 * n;
        std::map<std::pair<int, int>, int> places;
        std::map<std::pair<int, int>, int> follows;
        for (int row = 0; row < rows; ++row) {
            const auto order = ordered(n, Order::latin_square, row, random);
            for (int i = 0; i < n; ++i) {
                ++places[{i, order[static_cast<size_t>(i)]}];
                if (i > 0)
                    ++follows[{order[static_cast<size_t>(i - 1)], order[static_cast<size_t>(i)]}];
            }
        }
        EXPECT_EQ(places.size(), static_cast<size_t>(n * n));
        EXPECT_EQ(follows.size(), static_cast<size_t>(n * (n - 1)));
        for (const auto& [which, count] : places) EXPECT_EQ(count, rows / n) << n;
        for (const auto& [which, count] : follows) EXPECT_EQ(count, rows / n) << n;
    }
}

TEST(Order, CounterbalancingGoesThroughAllPermutations) {
    Random random(1, "test");
    std::set<std::vector<int>> all;
    for (int number = 0; number < 24; ++number)
        all.insert(ordered(4, Order::counterbalanced, number, random));
    EXPECT_EQ(all.size(), 24u);
    EXPECT_EQ(ordered(4, Order::counterbalanced, 24, random), (std::vector<int>{0, 1, 2, 3}));
    EXPECT_EQ(participant_number("S07"), 7);
    EXPECT_EQ(participant_number("anna"), -1);
}

TEST(Order, TrialsHaveTheirKindsSharesAndInsertsAndTheSeedDecides) {
    Files files;
    const Plan plan = make_plan(files.request(3));
    const std::vector<Trial>& trials = plan.task->trials;
    ASSERT_EQ(trials.size(), 2u + 5u + 2u);
    int caught = 0;
    for (size_t i = 2; i < 7; ++i) {
        EXPECT_EQ(trials[i].number, 2);
        EXPECT_EQ(trials[i].in_block, static_cast<int>(i) - 1);
        caught += trials[i].kind == TrialKind::catch_trial;
        EXPECT_EQ(trials[i].perturb, trials[i].kind == TrialKind::catch_trial ? -1 : 0);
    }
    EXPECT_EQ(caught, 1);
    EXPECT_EQ(trials[2].kind, TrialKind::perturbed);
    EXPECT_EQ(trials[2].share, 0.5);
    EXPECT_EQ(trials[6].share, 1);
    EXPECT_EQ(trials[7].condition, 0);  // sequential
    EXPECT_EQ(trials[8].condition, 1);
    const auto conditions = [&](uint64_t seed) {
        std::string out;
        const Plan of_seed = make_plan(files.request(seed));
        for (const Trial& t : of_seed.task->trials) out += std::to_string(t.condition);
        return out;
    };
    EXPECT_EQ(conditions(3), conditions(3));
    std::set<std::string> different;
    for (uint64_t seed = 1; seed < 9; ++seed) different.insert(conditions(seed));
    EXPECT_GT(different.size(), 3u);
}

TEST(Order, ParticipantsNumbersOrderRounds) {
    Files files;
    files.replace("  redo: next\n",
                  "  redo: next\n  round_order: latin_square\n"
                  "  rounds: [{ name: a }, { name: b }]\n");
    EXPECT_EQ(make_plan(files.request(1, "S01")).task->trials.front().round, 0);
    EXPECT_EQ(make_plan(files.request(1, "S02")).task->trials.front().round, 1);
    EXPECT_THROW(make_plan(files.request(1, "")), Error);
}

TEST(TrialQueue, DoesTrialsAgainWhereThePolicySays) {
    std::vector<Trial> trials(5);
    for (size_t i = 0; i < 5; ++i) trials[i].number = i < 3 ? 1 : 2;
    const auto done = [&](Redo redo, int bad_attempts) {
        TrialQueue queue(trials, redo, 3, 1);
        std::string out;
        while (!queue.empty()) {
            out += std::to_string(queue.trial());
            queue.finish(queue.trial() == 0 && queue.attempt() <= bad_attempts);
        }
        return out;
    };
    EXPECT_EQ(done(Redo::never, 9), "01234");
    EXPECT_EQ(done(Redo::next, 1), "001234");
    EXPECT_EQ(done(Redo::end_of_block, 1), "012034");
    EXPECT_EQ(done(Redo::end_of_block, 9), "0120034");  // three attempts and no more
    EXPECT_EQ(done(Redo::random, 1).substr(done(Redo::random, 1).size() - 2), "34");
    EXPECT_EQ(done(Redo::random, 1), done(Redo::random, 1));
}

TEST(Task, RunsItsTrialsRecordsThemAndReplaysToTheBit) {
    Files files;
    files.replace("perturb: clamp", "perturb: channel");
    const Plan plan = make_plan(files.request());
    const RunResult result = files.run(plan);
    const analysis::SessionFigures figures = finish(result);
    EXPECT_EQ(figures.status & ~uint32_t{servo::kSoftStarted}, 0u);
    EXPECT_EQ(column(result.folder, "outcome"), std::vector<std::string>(9, "reached"));
    const auto number = column(result.folder, "trial_num");
    for (size_t i = 0; i < 9; ++i) EXPECT_EQ(number[i], std::to_string(i + 1));
    // the hand of the file does not adapt
    const auto hand = column(result.folder, "hand_angle_deg");
    const auto shown = column(result.folder, "shown_angle_deg");
    for (size_t i = 0; i < 9; ++i) {
        const Trial& trial = plan.task->trials[i];
        EXPECT_NEAR(std::stod(hand[i]), 0, 0.2) << i;
        const double turned = trial.perturb == 0 ? 30 * trial.share : 0;
        EXPECT_NEAR(std::stod(shown[i]), turned, 0.2) << i;
    }
    std::map<std::string, int> events;
    for (const auto& row : read_csv(result.folder + "/events.csv")) ++events[row[2]];
    EXPECT_EQ(events["marker"], 9);
    EXPECT_EQ(events["outcome"], 9);
    EXPECT_EQ(events["trial"], 9);
    EXPECT_EQ(events["perturbation"], 2 * 6);  // on and off
    EXPECT_GT(events["message"], 0);
    EXPECT_TRUE(replay_session(result.folder, kGoOn, {}).good());
    EXPECT_EQ(read_csv(result.folder + "/trial-list.csv").size(), 10u);
}

TEST(Task, AChannelPushesBackByItsStiffnessTimesTheDeviation) {
    Files files;
    files.replace("perturb: clamp", "perturb: channel");
    // a hand that goes astray: 10 mm to the side
    files.replace("hand: [{ duration_s: 0.2, reach: target }]",
                  "hand: [{ duration_s: 0.2, reach: target, move_mm: [10, 10, 0] }]");
    const Plan plan = make_plan(files.request());
    const RunResult result = files.run(plan);
    recording::RawLogReader log(result.folder + "/raw.log");
    int pushed = 0;
    double most = 0;
    while (const servo::Frame* frame = log.next()) {
        if (frame->trial != 8 || frame->task.loads.empty()) continue;
        ++pushed;
        const servo::FingerFrame& finger = frame->fingers[0];  // condition right: along x
        const Vec3 off(0, finger.p_WH.y(), finger.p_WH.z() - 0.12);
        const Vec3 across(0, finger.v_WH.y(), finger.v_WH.z());
        EXPECT_LT((frame->task.loads[0].force_W + 1000 * off + 5 * across).norm(), 1e-12);
        EXPECT_EQ(frame->task.loads[0].body, 2);  // the handle
        most = std::max(most, finger.f_sent_W.norm());
    }
    EXPECT_GT(pushed, 50);
    EXPECT_GT(most, 0.5);
    EXPECT_TRUE(replay_session(result.folder, kGoOn, {}).good());
}

TEST(Task, DoesAbortedTrialsAgain) {
    Files files;
    files.replace("hand: [{ duration_s: 0.2, reach: target }]",
                  "hand: [{ duration_s: 3, reach: target }]");
    const RunResult result = files.run(make_plan(files.request()));
    finish(result);
    EXPECT_EQ(column(result.folder, "outcome"), std::vector<std::string>(27, "too slow"));
    const auto attempt = column(result.folder, "attempt");
    for (size_t i = 0; i < 27; ++i) EXPECT_EQ(attempt[i], std::to_string(i % 3 + 1));
}

TEST(Task, PutsObjectsBackOnceFingersAreClearOfTheirPlaces) {
    Files files;
    files.experiment = R"(scene: scene.yaml
hand: { centre_mm: [-60, 0, 20] }
task:
  states:
    - name: push
      exits:
        - { when: touched, body: block, to: slide }
        - { when: time, hold_s: 2, outcome: missed }
      hand: [{ duration_s: 0.6, move_mm: [140, 0, 0] }]
    - name: slide
      exits: [{ when: time, hold_s: 0.5, to: stay }]
      hand: [{ duration_s: 0.3, move_mm: [40, 0, 0] }]
    - name: stay
      exits: [{ when: still, hold_s: 0.1, speed_mm_s: 5, to: back }]
    - name: back
      exits: [{ when: time, hold_s: 0.6, outcome: pushed }]
      hand: [{ duration_s: 0.2, move_mm: [0, 0, 60] }, { duration_s: 0.4, move_mm: [-140, 0, -60] }]
  blocks: [{ name: all, repeats: 3 }]
)";
    const RunResult result = files.run(make_plan(files.request()));
    finish(result);
    EXPECT_EQ(column(result.folder, "outcome"), std::vector<std::string>(3, "pushed"));
    recording::RawLogReader log(result.folder + "/raw.log");
    double farthest = 0;
    double force = 0;
    int placed = 0;
    int trial = 0;
    while (const servo::Frame* frame = log.next()) {
        const double x = frame->bodies[1].X_WB.p.x();
        farthest = std::max(farthest, x);
        force = std::max(force, frame->fingers[0].f_sent_W.norm());
        placed += static_cast<int>(frame->task.placements.size());
        if (frame->trial != trial) {
            EXPECT_NEAR(x, 0, 1e-6);
            trial = frame->trial;
        }
    }
    EXPECT_GT(farthest, 0.03);
    EXPECT_EQ(placed, 2);
    EXPECT_LT(force, 8);  // nothing is pushed out of anything
    EXPECT_TRUE(replay_session(result.folder, kGoOn, {}).good());
}

TEST(Task, GoesOnAtTheRightTrialAfterAnInterruption) {
    Files files;
    const Plan plan = make_plan(files.request());
    const RunResult whole = files.run(plan);
    finish(whole);
    for (const int ticks : {5, 700, 1234, 2000}) {
        // what a kill leaves: a log that is cut
        const RunResult cut = files.run(make_plan(files.request()));
        recording::RawLogReader all(cut.folder + "/raw.log");
        const recording::LogHead head = all.head();
        std::vector<servo::Frame> frames;
        for (int i = 0; i < ticks; ++i) frames.push_back(*all.next());
        fs::remove(cut.folder + "/raw.log");
        {
            recording::RawLogWriter log(cut.folder + "/raw.log", head);
            std::vector<std::byte> bytes(recording::most_bytes(head.layout(), 100));
            for (const servo::Frame& frame : frames) {
                const size_t size = recording::encode(frame, bytes, recording::Bodies::all);
                log.add(std::span(bytes).first(size));
            }
        }
        const auto folder = recording::SessionFolder::open(cut.folder);
        analysis::recover_session(folder, {});
        recording::SessionInfo info;
        const Plan rest = make_rest(cut.folder, info);
        const RunResult second = files.run(rest);
        finish(second);
        EXPECT_EQ(column(second.folder, "trial_num"), column(whole.folder, "trial_num")) << ticks;
        EXPECT_EQ(column(second.folder, "outcome"), column(whole.folder, "outcome")) << ticks;
        EXPECT_EQ(column(second.folder, "condition"), column(whole.folder, "condition")) << ticks;
        EXPECT_EQ(column(second.folder, "session_num").back(), "2");
        EXPECT_TRUE(replay_session(second.folder, kGoOn, {}).good());
        EXPECT_THROW(make_rest(second.folder, info), Error);  // complete
    }
}

TEST(Task, AllocatesNothingInTheTick) {
    DIHAPTIC_NEEDS_ALLOCATION_GUARD();
    Files files;
    const Plan plan = make_plan(files.request());
    const auto servo = make_servo(plan);
    TaskDirector task(*plan.task, plan.seed, plan.settings.tick());
    plan.seeing->restart();
    servo->activate();
    const servo::Director director =
        [&](const servo::Frame& last, std::span<const haptics::Handle> handles,
            servo::Commands& commands) { task(last, handles, commands); };
    Time now{0};
    const testing::AllocationGuard guard;
    while (!servo->stopped() && seconds(now) < 30) {
        plan.seeing->see(servo->tick(now, director));
        now += servo->period();
    }
    EXPECT_EQ(guard.count(), 0u);
    EXPECT_EQ(task.share(), 1);
}

TEST(Task, AKeyEndsAState) {
    Files files;
    files.replace("- { when: outside, region: shell, outcome: reached, feedback: Good }",
                  "- { when: key, key: y, outcome: reached }");
    const Plan plan = make_plan(files.request());
    const auto servo = make_servo(plan);
    TaskDirector task(*plan.task, plan.seed, plan.settings.tick());
    servo->activate();
    int outcome = -1;
    for (int i = 0; i < 600 && outcome < 0; ++i) {
        if (i == 400) task.press('n');
        if (i == 500) task.press('y');
        const servo::Frame& frame =
            servo->tick(i * std::chrono::milliseconds(1),
                        [&](const servo::Frame& last, std::span<const haptics::Handle> handles,
                            servo::Commands& commands) { task(last, handles, commands); });
        plan.seeing->see(frame);
        outcome = frame.task.outcome;
        if (outcome >= 0) {
            EXPECT_EQ(i, 500);
        }
    }
    EXPECT_EQ(plan.task->outcomes.at(static_cast<size_t>(std::max(0, outcome))).name, "reached");
}

TEST(ShippedTask, RotatesWhatIsShownAboutEachRoundsAxisAndReplaysToTheBit) {
    const testing::TemporaryFolder folder;
    Request request;
    request.file = "experiments/visuomotor-rotation.yaml";
    request.participant = "S02";
    Plan plan = make_plan(request);
    const auto some = std::make_shared<TaskPlan>(*plan.task);
    // the beginning of each block of the first two rounds
    std::erase_if(some->trials, [](const Trial& trial) {
        return trial.number > 8 || trial.in_block > (trial.block == 1 ? 8 : 2);
    });
    plan.task = some;
    plan.seeing = std::make_shared<TaskHand>(some, plan.hand, scene::finger_names(plan.scene));
    plan.driver = plan.seeing;
    RunOptions options;
    options.out = folder.path();
    const RunResult result = run_session(plan, options, kGoOn, {});
    finish(result);
    const auto outcome = column(result.folder, "outcome");
    const auto kind = column(result.folder, "kind");
    const auto hand = column(result.folder, "hand_angle_deg");
    const auto shown = column(result.folder, "shown_angle_deg");
    ASSERT_EQ(outcome.size(), some->trials.size());
    std::map<std::string, int> kinds;
    for (size_t i = 0; i < outcome.size(); ++i) {
        ++kinds[kind[i]];
        EXPECT_EQ(outcome[i], "reached");
        EXPECT_NEAR(std::stod(hand[i]), 0, 0.2);
        EXPECT_NEAR(std::stod(shown[i]), kind[i] == "perturbed" ? 30 : 0, 0.3) << i << kind[i];
    }
    EXPECT_GT(kinds["perturbed"], 10);
    EXPECT_EQ(kinds["error_clamp"], 4);
    EXPECT_TRUE(replay_session(result.folder, kGoOn, {}).good());
}

TEST(ShippedTask, CarriesABlockWhoseInertiaAndNotWeightIsThreefold) {
    const testing::TemporaryFolder folder;
    Request request;
    request.file = "experiments/directional-mass.yaml";
    Plan plan = make_plan(request);
    const auto some = std::make_shared<TaskPlan>(*plan.task);
    std::erase_if(some->trials, [](const Trial& trial) {
        return trial.in_block > 1 || trial.kind == TrialKind::practice ||
               trial.kind == TrialKind::washout;
    });
    ASSERT_EQ(some->trials.size(), 2u);
    plan.task = some;
    plan.seeing = std::make_shared<TaskHand>(some, plan.hand, scene::finger_names(plan.scene));
    plan.driver = plan.seeing;
    RunOptions options;
    options.out = folder.path();
    const RunResult result = run_session(plan, options, kGoOn, {});
    finish(result);
    EXPECT_EQ(column(result.folder, "outcome"), std::vector<std::string>(2, "carried"));
    recording::RawLogReader log(result.folder + "/raw.log");
    Vec3 v = Vec3::Zero();
    int carried = 0;
    int perturbed = 0;
    while (const servo::Frame* frame = log.next()) {
        const servo::BodyFrame& block = frame->bodies[1];
        const Vec3 a = (block.v_WB - v) / 1e-3;
        v = block.v_WB;
        if (frame->phase != 3) continue;
        // what the fingers' contacts do is m a, with the m of each axis, and the same weight
        Vec3 force = Vec3::Zero();
        for (const servo::FingerFrame& finger : frame->fingers) force -= finger.f_contact_W;
        const bool heavy = !frame->task.properties.empty();
        const double inertia = heavy ? 0.3 : 0.1;
        EXPECT_NEAR(force.x(), inertia * a.x(), 1e-6);
        EXPECT_NEAR(force.z(), 0.1 * (a.z() + 9.81), 1e-6);
        ++carried;
        perturbed += heavy;
    }
    EXPECT_GT(carried, 1500);
    EXPECT_GT(perturbed, 700);
    EXPECT_TRUE(replay_session(result.folder, kGoOn, {}).good());
}

/// A mistake: what is written in place of what, and what must be said of it, with the line.
struct Mistake {
    const char* what;
    const char* by;
    const char* said;
};

class BrokenFile : public ::testing::TestWithParam<Mistake> {};

TEST_P(BrokenFile, IsRefusedWithFileLineAndRemedy) {
    Files files;
    const size_t at = files.experiment.find(GetParam().what);
    ASSERT_NE(at, std::string::npos);
    files.experiment.replace(at, std::string(GetParam().what).size(), GetParam().by);
    Diagnostics diagnostics;
    check_file(files.request().file, diagnostics);
    bool found = false;
    std::string all;
    for (const Problem& p : diagnostics.problems()) {
        all += p.text() + "\n";
        if (p.severity != Severity::error || p.text().find(GetParam().said) == std::string::npos)
            continue;
        found = true;
        EXPECT_GT(p.place.line, 0) << p.text();
        EXPECT_NE(p.place.file.find("experiment.yaml"), std::string::npos) << p.text();
        EXPECT_FALSE(p.remedy.empty()) << p.text();
    }
    EXPECT_TRUE(found) << "not said: " << GetParam().said << "\nbut:\n" << all;
}

const char* const kExit = "{ when: outside, region: shell, outcome: reached, feedback: Good }";
const char* const kRotation =
    "visual: { moves: [proxies], about: start, axis: [0, 0, 1], angle_deg: 30 }";
const char* const kChannel =
    "field: { kind: channel, on: index, from: start, to: target, stiffness_N_m: 1000, "
    "damping_Ns_m: 5 }";
const char* const kBlock = "{ name: before, kind: baseline, repeats: 1 }";

INSTANTIATE_TEST_SUITE_P(
    Task, BrokenFile,
    ::testing::Values(
        Mistake{"name: shell,", "name: target,", "there are two regions 'target'"},
        Mistake{"name: shell,", "nam: shell,", "nam"},
        Mistake{"name: start, position_mm: [0, 0, 120]", "name: start", "position"},
        Mistake{"position_mm: [50, 0, 120]", "position_mm: [50, 120]", "must be three numbers"},
        Mistake{"position_mm: [50, 0, 120]", "position: [50, 0, 120]", "position"},
        Mistake{"radius_mm: 45", "radius_mm: -45", "radius_mm"},
        Mistake{"name: clamp\n", "name: rotation\n", "there are two perturbations 'rotation'"},
        Mistake{kRotation, "visual: { moves: [proxy], about: start }",
                "'proxy' is nothing to move"},
        Mistake{kRotation, "visual: { about: start, angle_deg: 30 }", "moves"},
        Mistake{kRotation, "visual: { moves: [proxies], about: strat }", "Did you mean start?"},
        Mistake{kRotation, "visual: { moves: [proxies], about: start, angle_deg: 30 }", "axis"},
        Mistake{kRotation,
                "visual: { moves: [proxies], about: start, axis: [0, 0, 0], angle_deg: 30 }",
                "has no direction"},
        Mistake{kRotation, "visual: { moves: [proxies], about: start, size: 2 }",
                "is the object's, which is not moved"},
        Mistake{"toward: target }", "toward: target, axis: [0, 0, 1], angle_deg: 3 }",
                "neither rotated nor scaled"},
        Mistake{kRotation, "body: { body: blok, mass_scale: [2, 2, 1] }", "Did you mean block?"},
        Mistake{kRotation, "body: { body: table, mass_scale: [2, 2, 1] }", "'table' cannot move"},
        Mistake{kRotation, "body: { body: block, mass_scale: 2 }", "must be three numbers"},
        Mistake{kRotation, "body: { body: block, weight_scale: heavy }", "must be a number"},
        Mistake{kRotation, "visual:", "visual"},
        Mistake{kChannel, "field: { kind: tunnel, on: index }", "tunnel"},
        Mistake{kChannel, "field: { kind: viscous, on: index }", "damping"},
        Mistake{kChannel, "field: { kind: viscous, on: idnex, damping_Ns_m: 5 }",
                "Did you mean index?"},
        Mistake{kChannel, "field: { kind: curl, on: index, damping_Ns_m: 5 }", "axis"},
        Mistake{kChannel, "field: { kind: channel, on: index, from: start, to: target }",
                "stiffness"},
        Mistake{kChannel, "field: { kind: channel, on: index, stiffness_N_m: 500 }", "from"},
        Mistake{"name: reach\n      show", "name: home\n      show", "there are two states 'home'"},
        Mistake{"show: [target]", "show: [tarket]", "Did you mean target?"},
        Mistake{"marker: 7", "marker: 700", "marker"},
        Mistake{"marker: 7", "marker: seven", "marker"},
        Mistake{kExit, "{ region: shell, outcome: reached }", "when"},
        Mistake{kExit, "{ when: outside, region: shel, outcome: reached }", "Did you mean shell?"},
        Mistake{kExit, "{ when: outside, outcome: reached }", "region"},
        Mistake{kExit, "{ when: outside, region: shell }", "leads nowhere"},
        Mistake{kExit, "{ when: outside, region: shell, to: home, outcome: reached }",
                "leads to a state and out of the trial"},
        Mistake{kExit, "{ when: outside, region: shell, to: hom }", "Did you mean home?"},
        Mistake{kExit, "{ when: outside, region: shell, finger: thumb, outcome: reached }",
                "none of the scene's fingers"},
        Mistake{kExit, "{ when: outside, region: shell, outcome: lost }", "'lost' is done again"},
        Mistake{kExit, "{ when: lifted, body: table, outcome: reached }", "'table' cannot move"},
        Mistake{kExit, "{ when: gripped, body: block, outcome: reached }", "a grip takes two"},
        Mistake{kExit, "{ when: key, key: enter, outcome: reached }", "is no key"},
        Mistake{kExit, "{ when: time, outcome: reached }", "how long is missing"},
        Mistake{kExit, "{ when: button, button: 40, outcome: reached }", "button"},
        Mistake{"duration_s: 0.2, reach: target", "duration_s: 0, reach: target", "duration_s"},
        Mistake{"duration_s: 0.2, reach: target", "reach: target", "duration"},
        Mistake{"during: reach", "during: rech", "Did you mean reach?"},
        Mistake{"distance_mm: 30", "distance_mm: 0", "distance_mm"},
        Mistake{"name: far\n", "name: right\n", "there are two conditions 'right'"},
        Mistake{"[{ name: target, position_mm: [0, 50, 120]",
                "[{ name: targe, position_mm: [0, 50, 120]", "Did you mean target?"},
        Mistake{"redo: next", "redo: later", "redo"},
        Mistake{kBlock, "{ name: before, kind: base }", "kind"},
        Mistake{kBlock, "{ name: before, conditions: [left] }", "'left' is no condition"},
        Mistake{kBlock, "{ name: before, repeats: 0 }", "repeats"},
        Mistake{kBlock, "{ name: before, order: random }", "order"},
        Mistake{kBlock, "{ name: before, kind: perturbed }", "is missing in a perturbed block"},
        Mistake{kBlock, "{ name: before, ramp: 3 }", "there is nothing to ramp"},
        Mistake{"perturb: rotation", "perturb: rotatoin", "Did you mean rotation?"},
        Mistake{"count: 1 }", "count: 5 }", "more than the block's 4 trials"},
        Mistake{"  blocks:\n", "  block:\n", "blocks"}));

}  // namespace
}  // namespace dihaptic::experiment
