// Tests sessions that are watched and steered by another thread, as by a window.
#include "session/listeners/live.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <numbers>
#include <thread>

#include "outlets/test/fallible.h"
#include "recording/raw_log.h"
#include "session/replay.h"
#include "session/test/reaches.h"

namespace dihaptic::session::live_test {
namespace {

using std::chrono::milliseconds;

/// Runs a session in its own thread until the session ends by itself or the desk ends it.
class Desk {
  public:
    explicit Desk(const Request& request) {
        plan = make_plan(request);
        knobs = frame::Knobs::of(plan.settings);
        RunOptions options;
        options.out = folder_.path();
        options.clock = Clock::real;
        options.live = &live;
        thread_ = std::thread(
            [this, options] { result = run_session(plan, options, stop_, Progress()); });
    }
    ~Desk() { end(); }
    void end() {
        live.ended = true;
        join();
    }
    void join() {
        if (thread_.joinable()) thread_.join();
    }

    /// Returns the newest frame once session time has reached `t`, or after ten seconds at the
    /// latest.
    const frame::Frame& at(double t) {
        for (int i = 0; i < 10000; ++i) {
            const frame::Frame& frame = live.frame.read();
            if (frame.sequence >= 0 && seconds(frame.time) >= t) return frame;
            std::this_thread::sleep_for(milliseconds(1));
        }
        ADD_FAILURE() << "session time " << t << " s was not reached";
        return live.frame.read();
    }
    double now() { return seconds(live.frame.read().time); }

    void squeeze(double aperture) {
        hand::Posture goal = plan.mouse->goal();
        goal.aperture = aperture;
        plan.mouse->follow(goal);
    }
    /// Lifts at 5 cm/s of session time. Each step waits until the previous one was made: otherwise,
    /// if a busy machine makes the session lose ticks, the hand would move on and be torn off the
    /// object that it holds.
    void lift(double height) {
        hand::Posture goal = plan.mouse->goal();
        const double end = goal.centre.z() + height;
        while (goal.centre.z() < end) {
            goal.centre.z() = std::min(end, goal.centre.z() + 0.0005);
            plan.mouse->follow(goal);
            at(now() + 0.01);
        }
    }

    Live live;
    Plan plan;
    frame::Knobs knobs;  // knobs requested by the watching thread
    RunResult result;

  private:
    testing::TemporaryFolder folder_;
    std::atomic<bool> stop_{false};
    std::thread thread_;
};

Request block(bool mouse) {
    Request request;
    request.file = "scenes/block-on-table.yaml";
    request.mouse = mouse;
    return request;
}

std::vector<frame::Frame> frames_of(const std::string& session) {
    std::vector<frame::Frame> frames;
    recording::RawLogReader log(session + "/raw.log");
    while (const frame::Frame* frame = log.next()) frames.push_back(*frame);
    return frames;
}

TEST(Live, TimeStandsStillInAPauseAndForceComesOnSoftlyAfterIt) {
    Desk desk(block(false));
    desk.at(1.3);  // gripped
    desk.live.paused = true;
    std::this_thread::sleep_for(milliseconds(100));
    const double paused_at = desk.now();
    std::this_thread::sleep_for(milliseconds(300));
    EXPECT_EQ(desk.now(), paused_at);
    desk.live.paused = false;
    desk.join();
    EXPECT_FALSE(desk.result.interrupted);
    EXPECT_EQ(desk.result.fault, "");

    const std::vector<frame::Frame> frames = frames_of(desk.result.folder);
    int resumed = 0;
    for (size_t i = 2; i < frames.size(); ++i) {
        // missed ticks have no frame; the pause does not count as session time
        EXPECT_LT(seconds(frames[i].time - frames[i - 1].time), 0.2);
        if ((frames[i].status & kResumed) == 0) continue;
        ++resumed;
        EXPECT_NE(frames[i].status & kSoftStarted, 0u);
        EXPECT_LT(frames[i].fingers[0].f_sent_W.norm(), 0.05);
        EXPECT_NE(frames[i - 1].status & kPaused, 0u);
        EXPECT_EQ(frames[i - 1].status & kForceOff, 0u);
        for (const frame::FingerFrame& finger : frames[i - 1].fingers)
            EXPECT_EQ(finger.f_sent_W,
                      Vec3::Zero());  // already zero in the last tick before the session resumes
        EXPECT_GT(frames[i - 2].fingers[0].f_sent_W.norm(), 0.5);
    }
    EXPECT_EQ(resumed, 1);
    EXPECT_TRUE(replay_session(desk.result.folder, {false}, {}).good());
}

TEST(Live, AMouseGripsAndLiftsTheBlockAndItsSessionIsWhole) {
    Desk desk(block(true));
    desk.at(0.2);
    desk.squeeze(0.034);
    desk.at(0.8);
    desk.lift(0.06);
    const frame::Frame& frame = desk.at(desk.now() + 0.3);
    EXPECT_NEAR(frame.bodies[1].X_WB.p.z(), 0.08, 0.005);
    desk.knobs.solver = contact::Solver::stewart_trinkle;
    desk.live.knobs.publish(desk.knobs);
    const frame::Frame& after = desk.at(desk.now() + 0.3);
    EXPECT_EQ(after.solver, contact::Solver::stewart_trinkle);
    EXPECT_NEAR(after.bodies[1].X_WB.p.z(), 0.08, 0.005);
    desk.end();
    EXPECT_FALSE(desk.result.interrupted);
    EXPECT_EQ(desk.result.info.state, recording::SessionState::complete);
    EXPECT_EQ(desk.result.info.phases.back().end, desk.result.simulated);
    EXPECT_TRUE(replay_session(desk.result.folder, {false}, {}).good());
}

TEST(Live, WorkspacesTurnAndFrictionChangesWhileABlockIsHeldAndTheReplayIsExact) {
    Desk desk(block(true));
    desk.at(0.2);
    desk.squeeze(0.034);
    desk.at(0.8);
    desk.lift(0.05);
    const double before = desk.at(desk.now() + 0.5).bodies[1].X_WB.p.z();
    ASSERT_GT(before, 0.06);
    desk.knobs.friction_scale = 1.5;
    desk.knobs.workspace_turn = std::numbers::pi / 2;
    desk.live.knobs.publish(desk.knobs);
    const frame::Frame& frame = desk.at(desk.now() + 3);
    EXPECT_NEAR(frame.workspace_turn, std::numbers::pi / 2, 0.02);
    EXPECT_EQ(frame.friction_scale, 1.5);
    EXPECT_NEAR(frame.bodies[1].X_WB.p.z(), before, 0.003);
    EXPECT_NEAR(angle_between(frame.bodies[1].X_WB.R, Quat::Identity()), std::numbers::pi / 2,
                0.05);
    desk.end();
    EXPECT_EQ(desk.result.fault, "");
    EXPECT_TRUE(replay_session(desk.result.folder, {false}, {}).good());
}

TEST(Live, ProxiesChangeOnceTheyAreClearOfEverythingAndTheReplayIsExact) {
    Request request = block(true);
    request.set.emplace_back("proxy.changeable=yes");
    Desk desk(request);
    desk.at(0.2);
    const double open = desk.plan.mouse->goal().aperture;
    desk.squeeze(0.034);
    EXPECT_GT(desk.at(desk.now() + 0.8).grip_force, 0.3);
    desk.knobs.proxy = scene::ProxyKind::point;
    desk.live.knobs.publish(desk.knobs);
    // stays the same while the fingers hold the block
    EXPECT_EQ(desk.at(desk.now() + 0.2).proxy, scene::ProxyKind::rigid);
    desk.squeeze(open);
    EXPECT_EQ(desk.at(desk.now() + 0.8).proxy, scene::ProxyKind::point);
    desk.squeeze(0.03);  // closes points on the block, as pads do
    const frame::Frame& held = desk.at(desk.now() + 1);
    EXPECT_GT(held.grip_force, 0.3);
    desk.end();
    EXPECT_EQ(desk.result.fault, "");
    EXPECT_TRUE(replay_session(desk.result.folder, {false}, {}).good());
}

TEST(Live, AfterAFaultTheSessionWaitsAndTheTrialIsDoneAgainOnceItGoesOn) {
    Files files;
    files.replace("hand: { centre_mm: [0, 0, 120] }",
                  "hand: { centre_mm: [0, 0, 120] }\nsettings: { safety: { max_speed_m_s: 0.2 } }");
    // a reach of 50 mm exceeds this speed if it takes 0.2 s, but not if it takes 0.8 s
    Desk desk(files.request());
    std::string told;
    for (int i = 0; i < 10000 && told.empty(); ++i) {
        told = desk.live.take_told();
        std::this_thread::sleep_for(milliseconds(1));
    }
    EXPECT_NE(told.find("moved at"), std::string::npos) << told;
    EXPECT_TRUE(desk.live.paused);
    const double at = desk.now();
    std::this_thread::sleep_for(milliseconds(100));
    EXPECT_EQ(desk.now(), at);  // the session is waiting
    desk.live.paused = false;
    desk.at(at + 0.3);
    desk.end();
    const std::vector<frame::Frame> frames = frames_of(desk.result.folder);
    int resumed = 0;
    bool off = false;
    int attempt = 0;
    for (const frame::Frame& frame : frames) {
        if ((frame.status & kResumed) == 0) {
            off = off || (frame.status & kForceOff) != 0;
            continue;
        }
        ++resumed;
        EXPECT_TRUE(off);
        EXPECT_EQ(frame.status & kForceOff, 0u);
        EXPECT_EQ(frame.trial, 1);
        attempt = frame.task.attempt;
    }
    EXPECT_EQ(resumed, 1);
    EXPECT_EQ(attempt, 2);
    EXPECT_TRUE(replay_session(desk.result.folder, {false}, {}).good());
}

TEST(Live, ATrialThatAPauseInterruptsBeginsAnew) {
    Files files;
    files.keep_first_block();
    Desk desk(files.request());
    desk.at(0.1);
    desk.live.paused = true;
    std::this_thread::sleep_for(milliseconds(50));
    desk.live.paused = false;
    desk.join();
    EXPECT_FALSE(desk.result.interrupted);
    int attempts = 0;
    for (const frame::Frame& frame : frames_of(desk.result.folder)) {
        if (frame.trial == 1) attempts = std::max(attempts, frame.task.attempt);
        if (frame.trial > 1) {
            EXPECT_LE(frame.task.attempt, 1);
        }
    }
    EXPECT_EQ(attempts, 2);
    EXPECT_TRUE(replay_session(desk.result.folder, {false}, {}).good());
}

TEST(Live, AWatcherThatFallsSilentTakesForceAwayWithinASecond) {
    Desk desk(block(true));
    desk.at(0.2);
    desk.squeeze(0.034);
    double last = 0;
    const auto end = Live::Clock::now() + milliseconds(1500);
    while (Live::Clock::now() < end) {  // calls for longer than it may stay silent
        desk.live.note_alive();
        last = desk.now();
        std::this_thread::sleep_for(milliseconds(20));
    }
    std::string told;
    for (int i = 0; i < 5000 && told.empty(); ++i) {
        told = desk.live.take_told();
        std::this_thread::sleep_for(milliseconds(1));
    }
    EXPECT_NE(told.find("the window has not answered for 1."), std::string::npos) << told;
    EXPECT_TRUE(desk.live.paused);
    desk.live.note_alive();
    desk.live.paused = false;
    desk.at(desk.now() + 0.5);
    desk.end();
    int off = 0;
    for (const frame::Frame& frame : frames_of(desk.result.folder)) {
        const double silence = seconds(frame.time) - last;
        const double force = frame.fingers[0].f_sent_W.norm();
        if (silence > 0 && silence < 0.9) {
            EXPECT_GT(force, 0.3) << silence;
        }
        if ((frame.status & kAbandoned) != 0) {
            ++off;
            EXPECT_NEAR(silence, Live::kLongestSilence, 0.1);
        }
        if ((frame.status & kForceOff) != 0) {
            EXPECT_EQ(force, 0);
        }
    }
    EXPECT_EQ(off, 1);
    EXPECT_TRUE(replay_session(desk.result.folder, {false}, {}).good());
}

TEST(Live, ASkippedTrialIsOverAndNotDoneAgain) {
    Files files;
    files.keep_first_block();
    Desk desk(files.request());
    desk.at(0.1);
    desk.live.skip = true;
    desk.join();
    EXPECT_EQ(desk.live.done, 1);
    const std::vector<frame::Frame> frames = frames_of(desk.result.folder);
    std::vector<std::string> outcomes;
    for (const frame::Frame& frame : frames) {
        if (frame.task.outcome < 0) continue;
        EXPECT_EQ(frame.task.attempt, 1);
        outcomes.push_back(desk.result.info.outcomes[static_cast<size_t>(frame.task.outcome)]);
    }
    ASSERT_EQ(outcomes.size(), desk.plan.task->trials.size());
    EXPECT_EQ(outcomes.front(), "skipped");
    EXPECT_EQ(std::count(outcomes.begin(), outcomes.end(), "reached"),
              static_cast<int>(outcomes.size()) - 1);
    EXPECT_TRUE(replay_session(desk.result.folder, {false}, {}).good());
}

TEST(Live, TriggersComeInAndEventCodesGoOutOnTheRigsSerialLine) {
    const testing::FarEnd far;
    Files files;
    files.experiment = "rig: rig.yaml\n" + files.experiment;
    files.replace("{ when: inside, region: start, hold_s: 0.2, to: reach }",
                  "{ when: trigger, to: reach }");
    files.folder.write("rig.yaml",
                       "devices: [{ finger: index, backend: simulated }]\n"
                       "outlets: [{ kind: serial, options: { port: " +
                           far.port + " } }]\n");
    Desk desk(files.request());
    EXPECT_TRUE(desk.plan.warnings.empty());
    desk.at(0.3);
    EXPECT_EQ(desk.live.frame.read().phase, 1);  // the trial is waiting
    far.send(200);
    EXPECT_EQ(far.receive(1), (std::vector<int>{7}));
    desk.end();
    for (const std::string& note : desk.result.info.notes)
        EXPECT_EQ(note.find("serial"), std::string::npos) << note;
    EXPECT_TRUE(replay_session(desk.result.folder, {false}, {}).good());
}

class LiveOutlet : public ::testing::TestWithParam<std::string> {
  protected:
    void SetUp() override {
        ASSERT_NE(fallible, nullptr) << "fallible.h does not say how this kind fails";
        files.experiment = "rig: rig.yaml\n" + files.experiment;
        files.folder.write("rig.yaml",
                           fmt::format("devices: [{{ finger: index, backend: simulated }}]\n"
                                       "outlets: [{{ kind: {}, options: {} }}]\n",
                                       GetParam(), fallible->options()));
        allow_library(fallible->options());
    }
    void TearDown() override { unsetenv("XDG_CONFIG_HOME"); }
    /// Adds the fake library to the user's own list, if the outlet uses a library.
    void allow_library(const std::string& options) {
        const Node node = parse_yaml(options, "options");
        const Node* const library = node.find("library");
        if (library == nullptr) return;
        std::filesystem::create_directories(files.folder.file("config/dihaptic"));
        files.folder.write("config/dihaptic/libraries.yaml", "- " + library->scalar + "\n");
        setenv("XDG_CONFIG_HOME", files.folder.file("config").c_str(), 1);
    }
    Files files;
    std::unique_ptr<outlets::Fallible> fallible = outlets::make_fallible(GetParam());
};
INSTANTIATE_TEST_SUITE_P(Kinds, LiveOutlet, ::testing::ValuesIn([] {
                             std::vector<std::string> out;
                             for (const outlets::Kind& kind : outlets::kinds())
                                 out.emplace_back(kind.name);
                             return out;
                         }()),
                         [](const auto& instance) { return instance.param; });

TEST_P(LiveOutlet, ThatCannotBeOpenedLeavesNoHalfSession) {
    fallible->never_open();
    RunOptions options;
    options.clock = Clock::real;
    options.out = files.folder.path() + "/sessions";
    const std::atomic<bool> stop{false};
    EXPECT_THROW(run_session(make_plan(files.request()), options, stop, {}), Error);
    std::error_code none;  // ignored: the folder may not even exist
    EXPECT_TRUE(!std::filesystem::exists(options.out) ||
                std::filesystem::is_empty(options.out, none));
}

TEST_P(LiveOutlet, ThatFailsIsInTheNotesOfASessionThatGoesOn) {
    files.keep_first_block();
    Desk desk(files.request());
    desk.at(0.1);
    fallible->fail();
    desk.join();
    EXPECT_FALSE(desk.result.interrupted);
    EXPECT_EQ(desk.result.fault, "");
    const auto told = [&](const std::string& note) { return note.starts_with(GetParam() + ": "); };
    EXPECT_EQ(std::ranges::count_if(desk.result.info.notes, told), 1);
    EXPECT_TRUE(replay_session(desk.result.folder, {false}, {}).good());
}

TEST(Live, AScriptThatIsEndedEarlyIsInterruptedWithoutAFault) {
    Desk desk(block(false));
    desk.at(0.3);
    desk.end();
    EXPECT_TRUE(desk.result.interrupted);
    EXPECT_EQ(desk.result.fault, "");
    EXPECT_TRUE(replay_session(desk.result.folder, {false}, {}).good());
}

TEST(Live, EasesWhatHoldsSomethingAndTurnsTheRestAtOnce) {
    Live live;
    const frame::Frame last;
    constexpr double kTick = 1e-3;
    frame::Knobs now = frame::Knobs::of({});
    const auto turn = [&](int ticks) {
        for (int i = 0; i < ticks; ++i) live.knobs.turn(last, kTick, now);
    };
    turn(10);
    EXPECT_EQ(now.stiffness, 1000);  // nothing has been requested yet
    frame::Knobs wanted = now;
    wanted.stiffness = 2000;
    wanted.smoothing = 0.5;
    wanted.proxy = scene::ProxyKind::point;
    live.knobs.publish(wanted);
    turn(100);
    EXPECT_NEAR(now.stiffness, 1500, 1e-6);
    EXPECT_TRUE(std::isnan(now.damping));
    EXPECT_EQ(now.smoothing, 0.5);
    EXPECT_EQ(now.proxy, scene::ProxyKind::rigid);  // the session does not allow the change
    wanted.friction_scale = 2;                      // halfway; the ramp does not start again
    live.knobs.publish(wanted);
    turn(1);
    EXPECT_EQ(now.friction_scale, 2);
    EXPECT_NEAR(now.stiffness, 1505, 1e-6);
    turn(100);
    EXPECT_EQ(now.stiffness, 2000);
    wanted.damping = 3;  // it was NaN before, which stands for k h / 2
    live.knobs.publish(wanted);
    turn(1);
    EXPECT_EQ(now.damping, 3);
}

TEST(Live, GivesASecondWatcherTheSameFrames) {
    Live live;
    live.second = std::make_shared<Latest<frame::Frame>>();
    frame::Frame frame;
    for (int i = 0; i < 10; ++i) {
        frame.sequence = i;
        frame.time = i * milliseconds(1);
        live.take(frame);
    }
    EXPECT_EQ(live.second->read().sequence, live.frame.read().sequence);
    EXPECT_GT(live.second->read().sequence, 4);
}

TEST(Live, TellsOfEachPictureInAHeadsetWhereTheHeadWasAndOfEachTickOnceThatItWasShown) {
    Live live;
    frame::Frame frame;
    frame.time = milliseconds(500);
    live.take(frame);
    const Pose X_WV{rotation_xyz({0.1, 0, 0}), {0.1, -0.4, 0.3}};
    const auto now = Live::Clock::now();
    live.note_shown(500, now, X_WV, true);
    live.note_shown(500, now + milliseconds(11), X_WV, false);  // a pause
    live.note_shown(530, now + milliseconds(22), X_WV, true);
    std::vector<recording::HeadSeen> heads;
    while (const auto head = live.take_head()) heads.push_back(*head);
    ASSERT_EQ(heads.size(), 3);
    EXPECT_EQ(heads[1].tick, 500);
    EXPECT_FALSE(heads[1].tracked);
    EXPECT_NEAR(heads[1].time - heads[0].time, 0.011, 1e-9);
    EXPECT_NEAR(heads[0].time, 0.5, 0.1);
    EXPECT_EQ(heads[0].p[1], -0.4);
    EXPECT_EQ(heads[0].R[0], X_WV.R.w());
    EXPECT_EQ(heads[0].R[1], X_WV.R.x());
    EXPECT_EQ(live.take_showing()->tick, 500);
    EXPECT_EQ(live.take_showing()->tick, 530);
    EXPECT_FALSE(live.take_showing());
}

TEST(Live, EndsInAPause) {
    Desk desk(block(true));
    desk.at(0.1);
    desk.live.paused = true;
    std::this_thread::sleep_for(milliseconds(50));
    desk.end();
    EXPECT_EQ(desk.result.fault, "");
    // measured in session time, because a busy machine skips ticks
    EXPECT_GE(desk.result.simulated, 0.1);
    const std::vector<frame::Frame> frames = frames_of(desk.result.folder);
    ASSERT_FALSE(frames.empty());
    EXPECT_NE(frames.back().status & kPaused, 0u);
}

TEST(Live, HandsOverEachAttemptAsItEnds) {
    Live live;
    frame::Frame frame;
    frame.fingers.resize(1);
    const auto tick = [&](int64_t sequence, int trial, int attempt, int outcome, double grip) {
        frame.sequence = sequence;
        frame.time = sequence * milliseconds(1);
        frame.trial = trial;
        frame.task.attempt = attempt;
        frame.task.outcome = outcome;
        frame.task.variables = {{0.1 * static_cast<double>(sequence)}};
        frame.grip_force = grip;
        frame.fingers[0].f_sent_W = {0, 0, -grip};
        live.take(frame);
    };
    tick(0, 0, 0, -1, 9);
    tick(1, 1, 1, -1, 2);
    tick(2, 1, 1, -1, 3);
    EXPECT_FALSE(live.take_trial_end());
    tick(3, 1, 1, 2, 1);
    tick(4, 1, 2, -1, 1);
    tick(5, 1, 2, 0, 1);
    tick(6, 1, 2, 0, 1);
    const auto first = live.take_trial_end();
    ASSERT_TRUE(first);
    EXPECT_EQ(first->trial, 1);
    EXPECT_EQ(first->attempt, 1);
    EXPECT_EQ(first->outcome, 2);
    EXPECT_NEAR(first->start, 0.001, 1e-12);
    EXPECT_NEAR(first->stop, 0.003, 1e-12);
    EXPECT_EQ(first->peak_grip, 3);
    EXPECT_EQ(first->peak_force, 3);
    EXPECT_NEAR(first->numbers[0], 0.3, 1e-12);
    EXPECT_TRUE(std::isnan(first->numbers[1]));
    const auto second = live.take_trial_end();
    ASSERT_TRUE(second);
    EXPECT_EQ(second->attempt, 2);
    EXPECT_EQ(second->outcome, 0);
    EXPECT_FALSE(live.take_trial_end());
}

}  // namespace
}  // namespace dihaptic::session::live_test
