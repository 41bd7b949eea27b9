// Tests tasks: states and their exits, perturbations given in the file, and sessions that are
// resumed.
#include "task/file/task.h"
#include "base/number.h"

#include <gtest/gtest.h>

#include <numbers>
#include <set>

#include "analysis/recovery.h"
#include "recording/raw_log.h"
#include "session/record.h"
#include "session/replay.h"
#include "session/test/allocations.h"
#include "session/test/reaches.h"
#include "task/run/task_director.h"
#include "task/run/task_hand.h"

namespace dihaptic::task::task_test {
namespace {

namespace fs = std::filesystem;

/// Returns a column of a session's trials.csv.
std::vector<std::string> column(const std::string& session, const std::string& name) {
    const CsvFile trials(session + "/trials.csv");
    std::vector<std::string> out;
    for (size_t i = 0; i < trials.rows(); ++i) out.push_back(trials.text(i, name));
    return out;
}

analysis::SessionFigures finish(const session::RunResult& result) {
    return analysis::finish_session(recording::SessionFolder::open(result.folder), result.info, {});
}

/// Runs only some of the plan's trials, as a session in the folder `out`.
session::Recorded run_some(session::Plan& plan, const std::shared_ptr<const TaskPlan>& some,
                           const std::string& out) {
    plan.task = some;
    plan.seeing = std::make_shared<TaskHand>(some, plan.hand, scene::finger_names(plan.scene));
    plan.driver = plan.seeing;
    session::RunOptions options;
    options.out = out;
    return session::record(plan, options, session::kGoOn);
}

TEST(Task, RunsItsTrialsRecordsThemAndReplaysToTheBit) {
    session::Files files;
    files.replace("kind: visual_clamp, perturb: clamp", "kind: force_channel, perturb: channel");
    const session::Plan plan = session::make_plan(files.request());
    const session::RunResult result = files.run(plan);
    const analysis::SessionFigures figures = finish(result);
    EXPECT_EQ(figures.status & ~uint32_t{kSoftStarted}, 0u);
    EXPECT_EQ(column(result.folder, "outcome"), std::vector<std::string>(9, "reached"));
    const auto number = column(result.folder, "trial_num");
    for (size_t i = 0; i < 9; ++i) EXPECT_EQ(number[i], number_text(i + 1));
    // the simulated hand of the file does not adapt
    const auto hand = column(result.folder, "hand_angle_deg");
    const auto shown = column(result.folder, "shown_angle_deg");
    for (size_t i = 0; i < 9; ++i) {
        const Trial& trial = plan.task->trials[i];
        EXPECT_NEAR(finite_number(hand[i]).value(), 0, 0.2) << i;
        const double turned = trial.perturb == std::vector{0} ? 30 * trial.share : 0;
        EXPECT_NEAR(finite_number(shown[i]).value(), turned, 0.2) << i;
    }
    std::map<std::string, int> events;
    for (const auto& row : read_csv(result.folder + "/events.csv")) ++events[row[2]];
    EXPECT_EQ(events["marker"], 9);
    EXPECT_EQ(events["outcome"], 9);
    EXPECT_EQ(events["trial"], 9);
    EXPECT_EQ(events["perturbation"], 2 * 6);  // start and end
    EXPECT_GT(events["message"], 0);
    EXPECT_TRUE(session::replay_session(result.folder, session::kGoOn, {}).good());
    EXPECT_EQ(read_csv(result.folder + "/trial-list.csv").size(), 10u);
}

TEST(Task, AChannelPushesBackByItsStiffnessTimesTheDeviation) {
    session::Files files;
    files.replace("kind: visual_clamp, perturb: clamp", "kind: force_channel, perturb: channel");
    // the hand deviates to the side by 10 mm
    files.replace("simulated_hand: [{ duration_s: 0.2, reach: target }]",
                  "simulated_hand: [{ duration_s: 0.2, reach: target, move_mm: [10, 10, 0] }]");
    const session::Plan plan = session::make_plan(files.request());
    const session::RunResult result = files.run(plan);
    recording::RawLogReader log(result.folder + "/raw.log");
    int pushed = 0;
    double most = 0;
    while (const frame::Frame* frame = log.next()) {
        if (frame->trial != 8 || frame->task.loads.empty()) continue;
        ++pushed;
        // condition right: the movement is along x
        const frame::FingerFrame& finger = frame->fingers[0];
        const Vec3 off(0, finger.p_WH.y(), finger.p_WH.z() - 0.12);
        const Vec3 across(0, finger.v_WH.y(), finger.v_WH.z());
        EXPECT_LT((frame->task.loads[0].force_W + 1000 * off + 5 * across).norm(), 1e-12);
        EXPECT_EQ(frame->task.loads[0].body, 2);  // the handle
        most = std::max(most, finger.f_sent_W.norm());
    }
    EXPECT_GT(pushed, 50);
    EXPECT_GT(most, 0.5);
    EXPECT_TRUE(session::replay_session(result.folder, session::kGoOn, {}).good());
}

/// Returns the block's frames in the first trial, in which the block falls freely through a field
/// for 0.2 s.
std::vector<frame::BodyFrame> fall_through(const std::string& field) {
    session::Files files;
    files.scene.replace(files.scene.find("position_mm: [0, 0, 20]"), 23,
                        "position_mm: [200, 0, 500]");
    files.experiment =
        "title: Fall\nscene: scene.yaml\nhand: { centre_mm: [0, 0, 120] }\ntask:\n"
        "  perturbations: [{ name: field, field: { on: block, " +
        field +
        " } }]\n"
        "  states:\n"
        "    - { name: fall, exits: [{ when: time, after_s: 0.2, outcome: done }], "
        "simulated_hand: [{ duration_s: 0.2 }] }\n"
        "  blocks: [{ name: all, kind: perturbed, perturb: field }]\n";
    const session::RunResult result = files.run(session::make_plan(files.request()));
    std::vector<frame::BodyFrame> out;
    recording::RawLogReader log(result.folder + "/raw.log");
    while (const frame::Frame* frame = log.next()) {
        // no perturbation acts in the last tick of the trial
        if (frame->trial == 1 && frame->task.outcome < 0) out.push_back(frame->bodies[1]);
    }
    EXPECT_GT(out.size(), 190u);
    return out;
}

constexpr double kMass = 0.1;
constexpr double kGravity = 9.81;

TEST(Task, ABodyFallsThroughAViscousFieldTowardItsTerminalVelocity) {
    const double b = 1;  // the block reaches terminal velocity after about 0.1 s
    double t = 0;
    for (const frame::BodyFrame& block : fall_through("kind: viscous, damping_Ns_m: 1")) {
        t += 1e-3;
        const double closed = -kMass * kGravity / b * (1 - std::exp(-b * t / kMass));
        EXPECT_NEAR(block.v_WB.z(), closed, 0.006);  // at first, v changes by 10 mm/s per tick
        EXPECT_NEAR(block.v_WB.x(), 0, 1e-12);
    }
}

TEST(Task, ABodyFallsThroughACurlFieldOnACycloid) {
    // m a = m g + b e x v rotates v - d at the rate b / m, where the drift d satisfies m g + b e x
    // d = 0
    const double rate = 2 / kMass;
    const double drift = kGravity / rate;
    double t = 0;
    for (const frame::BodyFrame& block :
         fall_through("kind: curl, axis: [0, 1, 0], damping_Ns_m: 2")) {
        t += 1e-3;
        // for e = y: dv_x = rate v_z, dv_z = -g - rate v_x
        const double v_x = -drift * (1 - std::cos(rate * t));
        const double v_z = -drift * std::sin(rate * t);
        EXPECT_NEAR(block.v_WB.x(), v_x, 0.04 * drift);  // v turns by 0.02 rad per tick
        EXPECT_NEAR(block.v_WB.z(), v_z, 0.04 * drift);
        EXPECT_NEAR(block.v_WB.y(), 0, 1e-12);
    }
    EXPECT_GT(rate * t, 3);  // about half a turn
}

TEST(Task, DoesAbortedTrialsAgain) {
    session::Files files;
    files.replace("simulated_hand: [{ duration_s: 0.2, reach: target }]",
                  "simulated_hand: [{ duration_s: 3, reach: target }]");
    const session::RunResult result = files.run(session::make_plan(files.request()));
    finish(result);
    EXPECT_EQ(column(result.folder, "outcome"), std::vector<std::string>(27, "too slow"));
    const auto attempt = column(result.folder, "attempt");
    for (size_t i = 0; i < 27; ++i) EXPECT_EQ(attempt[i], number_text(i % 3 + 1));
}

TEST(Task, PutsObjectsBackOnceFingersAreClearOfTheirPlaces) {
    session::Files files;
    files.experiment = R"(scene: scene.yaml
hand: { centre_mm: [-60, 0, 20] }
task:
  states:
    - name: push
      exits:
        - { when: touched, body: block, to: slide }
        - { when: time, after_s: 2, outcome: missed }
      simulated_hand: [{ duration_s: 0.6, move_mm: [140, 0, 0] }]
    - name: slide
      exits: [{ when: time, after_s: 0.5, to: stay }]
      simulated_hand: [{ duration_s: 0.3, move_mm: [40, 0, 0] }]
    - name: stay
      exits: [{ when: still, hold_s: 0.1, speed_mm_s: 5, to: back }]
    - name: back
      exits: [{ when: time, after_s: 0.6, outcome: pushed }]
      simulated_hand: [{ duration_s: 0.2, move_mm: [0, 0, 60] }, { duration_s: 0.4, move_mm: [-140, 0, -60] }]
  blocks: [{ name: all, repeats: 3 }]
)";
    const session::RunResult result = files.run(session::make_plan(files.request()));
    finish(result);
    EXPECT_EQ(column(result.folder, "outcome"), std::vector<std::string>(3, "pushed"));
    recording::RawLogReader log(result.folder + "/raw.log");
    double farthest = 0;
    double force = 0;
    int placed = 0;
    int trial = 0;
    while (const frame::Frame* frame = log.next()) {
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
    EXPECT_EQ(placed, 3);  // once before each trial
    EXPECT_LT(force, 8);   // the block is not pushed out of another body
    EXPECT_TRUE(session::replay_session(result.folder, session::kGoOn, {}).good());
}

TEST(Task, ConditionsPutObjectsInPlacesOfTheirOwn) {
    session::Files files;
    files.replace(
        "    - name: right\n",
        "    - name: right\n      places: [{ body: block, position_mm: [100, 50, 20] }]\n");
    const session::Plan plan = session::make_plan(files.request());
    const auto servo = session::make_servo(plan);
    TaskDirector task(*plan.task, plan.seed, plan.settings.tick());
    servo->activate();
    std::set<int> seen;
    Time now{0};
    while (!servo->stopped() && seconds(now) < 60) {
        const frame::Frame& frame =
            servo->tick(now, [&](const frame::Frame& last, std::span<const frame::Handle> handles,
                                 frame::Commands& commands) { task(last, handles, commands); });
        plan.seeing->see(frame);
        now += servo->period();
        if (frame.phase < 1) continue;
        const int condition = plan.task->trials[static_cast<size_t>(frame.trial) - 1].condition;
        seen.insert(condition);
        const Vec3 p = condition == 0 ? Vec3(0.1, 0.05, 0.02) : Vec3(0, 0, 0.02);
        ASSERT_LT((frame.bodies[1].X_WB.p - p).norm(), 1e-5) << frame.trial;
    }
    EXPECT_EQ(seen.size(), 2u);
}

TEST(Task, ASimulatedHandThatStaysInTheWayDoesNotFillTheDisk) {
    session::Files files;
    // in the second trial, the block is placed where the hand is at the end of the first trial
    files.replace("    - name: far\n",
                  "    - name: far\n      places: [{ body: block, position_mm: [50, 0, 120] }]\n");
    files.replace("    - { name: before, kind: baseline, repeats: 1 }\n",
                  "    - { name: before, kind: baseline, repeats: 1, order: sequential }\n");
    const session::RunResult result = files.run(session::make_plan(files.request()));
    EXPECT_TRUE(result.interrupted);
    EXPECT_NE(result.fault.find("never ended 'between trials' of trial 2"), std::string::npos)
        << result.fault;
    EXPECT_LT(result.simulated, 70);
}

TEST(Task, GoesOnAtTheRightTrialAfterAnInterruption) {
    session::Files files;
    const session::Plan plan = session::make_plan(files.request());
    const session::RunResult whole = files.run(plan);
    finish(whole);
    for (const int ticks : {5, 700, 1234, 2000}) {
        // a session that is killed leaves a truncated log
        const session::RunResult cut = files.run(session::make_plan(files.request()));
        recording::RawLogReader all(cut.folder + "/raw.log");
        const recording::LogHead head = all.head();
        std::vector<frame::Frame> frames;
        for (int i = 0; i < ticks; ++i) frames.push_back(*all.next());
        fs::remove(cut.folder + "/raw.log");
        {
            recording::RawLogWriter log(cut.folder + "/raw.log", head);
            std::vector<std::byte> bytes(recording::most_bytes(head.layout(), 100));
            for (const frame::Frame& frame : frames) {
                const size_t size = recording::encode(frame, bytes, recording::Bodies::all);
                log.add(std::span(bytes).first(size));
            }
        }
        const auto folder = recording::SessionFolder::open(cut.folder);
        analysis::recover_session(folder, {});
        recording::SessionInfo info;
        const session::Plan rest = session::make_rest(cut.folder, session::Seat::terminal, info);
        const session::RunResult second = files.run(rest);
        finish(second);
        EXPECT_EQ(column(second.folder, "trial_num"), column(whole.folder, "trial_num")) << ticks;
        EXPECT_EQ(column(second.folder, "outcome"), column(whole.folder, "outcome")) << ticks;
        EXPECT_EQ(column(second.folder, "condition"), column(whole.folder, "condition")) << ticks;
        EXPECT_EQ(column(second.folder, "session_num").back(), "2");
        EXPECT_TRUE(session::replay_session(second.folder, session::kGoOn, {}).good());
        EXPECT_THROW(session::make_rest(second.folder, session::Seat::terminal, info),
                     Error);  // complete
    }
}

TEST(Task, AllocatesNothingInTheTick) {
    DIHAPTIC_NEEDS_ALLOCATION_GUARD();
    session::Files files;
    session::expect_no_allocation(session::make_plan(files.request()), 30);
}

TEST(Task, AKeyEndsAState) {
    session::Files files;
    files.replace("- { when: outside, region: shell, outcome: reached, feedback: Good }",
                  "- { when: key, key: y, outcome: reached }");
    const session::Plan plan = session::make_plan(files.request());
    const auto servo = session::make_servo(plan);
    TaskDirector task(*plan.task, plan.seed, plan.settings.tick());
    servo->activate();
    int outcome = -1;
    for (int i = 0; i < 600 && outcome < 0; ++i) {
        if (i == 400) task.press('n');
        if (i == 500) task.press('y');
        const frame::Frame& frame =
            servo->tick(i * std::chrono::milliseconds(1),
                        [&](const frame::Frame& last, std::span<const frame::Handle> handles,
                            frame::Commands& commands) { task(last, handles, commands); });
        plan.seeing->see(frame);
        outcome = frame.task.outcome;
        if (outcome >= 0) {
            EXPECT_EQ(i, 500);
        }
    }
    EXPECT_EQ(plan.task->outcomes.at(static_cast<size_t>(std::max(0, outcome))).name, "reached");
}

/// A director of the task in these files, called tick by tick. One finger is where the block
/// belongs, and the block is somewhere else.
struct Asked {
    explicit Asked(session::Files& files) : plan(session::make_plan(files.request())) {
        last.fingers.resize(1);
        last.bodies.resize(2);
        last.bodies[1].X_WB.p = {0.2, 0, 0.1};
        commands.task.reserve({2});
    }
    const frame::Commands& tick() {
        commands.task.clear();
        director(last, handles, commands);
        return commands;
    }

    session::Plan plan;
    TaskDirector director{*plan.task, 1, 1e-3};
    frame::Frame last;
    std::vector<frame::Handle> handles{{{0.23, 0, 0.1}, Vec3::Zero()}};
    frame::Commands commands;
};

TEST(Task, ATriggerEndsAStateAndComesOnceASecondToASimulatedSession) {
    session::Files files;
    files.replace("{ when: inside, region: start, hold_s: 0.2, to: reach }",
                  "{ when: trigger, code: 9, to: reach }");
    session::Plan plan = session::make_plan(files.request());
    ASSERT_FALSE(plan.warnings.empty());
    EXPECT_NE(plan.warnings.back().text().find("no line for receiving a trigger"),
              std::string::npos);
    const session::RunResult result = files.run(plan);
    finish(result);
    EXPECT_EQ(column(result.folder, "outcome"), std::vector<std::string>(9, "reached"));
    for (const auto& row : read_csv(result.folder + "/events.csv")) {
        if (row[2] != "phase" || row[3] != "reach") continue;
        const double time = finite_number(row[0]).value();
        EXPECT_NEAR(time, std::round(time), 1.5e-3);
    }

    Asked asked(files);
    const auto phase_after = [&](int code) {
        asked.director.trigger(code);
        return asked.tick().phase;
    };
    EXPECT_EQ(phase_after(9), kBetween);  // the finger is in the block's place
    asked.last.fingers[0].p_WP = asked.handles[0].p_WH;
    EXPECT_EQ(phase_after(0), 1);
    EXPECT_EQ(phase_after(8), 1);  // another code
    EXPECT_EQ(phase_after(9), 2);
}

TEST(Task, DoesNotTakeAnObjectOutOfFingersThatPressIt) {
    session::Files files;
    Asked asked(files);
    asked.last.fingers[0].p_WP = asked.handles[0].p_WH;
    asked.last.contacts.push_back({});
    asked.last.contacts[0].a = 1;
    asked.last.contacts[0].b = 2;  // the finger
    asked.last.contacts[0].normal_force = 1;
    const frame::Commands& held = asked.tick();
    EXPECT_TRUE(held.task.placements.empty());
    EXPECT_EQ(held.phase, kBetween);
    EXPECT_EQ(held.task.message, asked.plan.task->move_away);
    asked.last.contacts.clear();
    const frame::Commands& released = asked.tick();
    EXPECT_EQ(released.task.placements.size(), 1u);
    EXPECT_EQ(released.phase, 1);
}

TEST(Task, ATrialThatIsSkippedBeforeItBeginsHasARowAndIsNotDoneAgain) {
    session::Files files;
    Asked asked(files);
    asked.director.skip();
    const frame::Commands& skipped = asked.tick();
    EXPECT_EQ(skipped.trial, 1);
    EXPECT_EQ(skipped.task.outcome, asked.plan.task->skipped);
    EXPECT_NE(skipped.phase, kBetween);  // frames between trials do not belong to a trial
    EXPECT_EQ(asked.tick().trial, 2);
}

TEST(ShippedTask, RotatesWhatIsShownAboutEachRoundsAxisAndReplaysToTheBit) {
    const testing::TemporaryFolder folder;
    session::Request request;
    request.file = "experiments/visuomotor-rotation.yaml";
    request.participant = "S02";
    session::Plan plan = session::make_plan(request);
    const auto some = std::make_shared<TaskPlan>(*plan.task);
    // keep only the beginning of each block in the first two rounds
    std::erase_if(some->trials, [](const Trial& trial) {
        return trial.number > 8 || trial.in_block > (trial.block == 1 ? 8 : 2);
    });
    const session::RunResult result = run_some(plan, some, folder.path());
    const auto outcome = column(result.folder, "outcome");
    const auto kind = column(result.folder, "kind");
    const auto hand = column(result.folder, "hand_angle_deg");
    const auto shown = column(result.folder, "shown_angle_deg");
    ASSERT_EQ(outcome.size(), some->trials.size());
    std::map<std::string, int> kinds;
    for (size_t i = 0; i < outcome.size(); ++i) {
        ++kinds[kind[i]];
        EXPECT_EQ(outcome[i], "reached");
        EXPECT_NEAR(finite_number(hand[i]).value(), 0, 0.2);
        EXPECT_NEAR(finite_number(shown[i]).value(), kind[i] == "perturbed" ? 30 : 0, 0.3)
            << i << kind[i];
    }
    EXPECT_GT(kinds["perturbed"], 10);
    EXPECT_EQ(kinds["visual_clamp"], 4);
    EXPECT_TRUE(session::replay_session(result.folder, session::kGoOn, {}).good());
}

TEST(ShippedTask, CarriesABlockWhoseInertiaAndNotWeightIsThreefold) {
    const testing::TemporaryFolder folder;
    session::Request request;
    request.file = "experiments/directional-mass.yaml";
    session::Plan plan = session::make_plan(request);
    const auto some = std::make_shared<TaskPlan>(*plan.task);
    std::erase_if(some->trials, [](const Trial& trial) {
        return trial.in_block > 1 || trial.kind == TrialKind::practice ||
               trial.kind == TrialKind::washout;
    });
    ASSERT_EQ(some->trials.size(), 2u);
    const session::RunResult result = run_some(plan, some, folder.path());
    EXPECT_EQ(column(result.folder, "outcome"), std::vector<std::string>(2, "carried"));
    recording::RawLogReader log(result.folder + "/raw.log");
    Vec3 v = Vec3::Zero();
    int carried = 0;
    int perturbed = 0;
    while (const frame::Frame* frame = log.next()) {
        const frame::BodyFrame& block = frame->bodies[1];
        const Vec3 a = (block.v_WB - v) / 1e-3;
        v = block.v_WB;
        if (frame->phase != 3) continue;
        // the fingers' contact forces are m a, with a different m for each axis, minus the
        // unchanged weight
        Vec3 force = Vec3::Zero();
        for (const frame::FingerFrame& finger : frame->fingers) force -= finger.f_contact_W;
        const bool heavy = !frame->task.properties.empty();
        const double inertia = heavy ? 0.3 : 0.1;
        EXPECT_NEAR(force.x(), inertia * a.x(), 1e-6);
        EXPECT_NEAR(force.z(), 0.1 * (a.z() + 9.81), 1e-6);
        ++carried;
        perturbed += heavy;
    }
    EXPECT_GT(carried, 1500);
    EXPECT_GT(perturbed, 700);
    EXPECT_TRUE(session::replay_session(result.folder, session::kGoOn, {}).good());
}

}  // namespace
}  // namespace dihaptic::task::task_test
