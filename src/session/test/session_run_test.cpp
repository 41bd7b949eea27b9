#include "session/session_run.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <array>
#include <numbers>

#include "model/grasp.h"
#include "recording/raw_log.h"
#include "session/replay.h"
#include "session/test/repeats.h"
#include "testing/files.h"

namespace dihaptic::session::session_run_test {
namespace {

namespace fs = std::filesystem;

const std::atomic<bool> kGoOn{false};

RunResult run(const std::string& file, const std::string& out, const std::string& movement = "",
              Clock clock = Clock::virtual_clock, std::vector<std::string> set = {}) {
    Request request;
    request.file = file;
    request.movement = movement;
    request.set = std::move(set);
    RunOptions options;
    options.out = out;
    options.clock = clock;
    return run_session(make_plan(request), options, kGoOn, {});
}

class ShippedRun : public ::testing::TestWithParam<std::string> {};

TEST_P(ShippedRun, RunsRepeatsItselfAndReplaysToTheBit) {
    expect_repeats_and_replays(GetParam());
}

TEST(Session, ALiftOfEachThingBySightRepeatsItselfAndReplaysToTheBit) {
    const testing::TemporaryFolder folder;
    std::string text = testing::read_file("experiments/grip-by-sight.yaml");
    const auto replace = [&](const std::string& what, const std::string& by) {
        ASSERT_NE(text.find(what), std::string::npos) << what;
        text.replace(text.find(what), what.size(), by);
    };
    replace("../scenes", fs::absolute("scenes").string());
    replace("../rigs", fs::absolute("rigs").string());
    replace("repeats: 15", "repeats: 1");
    expect_repeats_and_replays(folder.write("by-sight.yaml", text));
}

std::vector<std::string> shipped() {
    std::vector<std::string> out;
    for (const char* folder : {"scenes", "experiments"}) {
        for (const auto& entry : fs::directory_iterator(folder)) {
            // the hand of this scene does nothing; only its experiment has a hand that moves
            if (entry.path().stem() == "block-on-stand") continue;
            // these have up to hundreds of trials: ShippedTask runs some of them, src/person/test
            // and test/cli/paradigms_test.py run them with simulated people
            if (testing::read_file(entry.path()).find("\ntask:\n") != std::string::npos) continue;
            out.push_back(entry.path().string());
        }
    }
    std::sort(out.begin(), out.end());
    return out;
}
INSTANTIATE_TEST_SUITE_P(Session, ShippedRun, ::testing::ValuesIn(shipped()));

TEST(Session, TheDemoKeepsEachFingerUnderThePremiumsContinuousForce) {
    const testing::TemporaryFolder folder;
    const RunResult result = run("experiments/lift-block.yaml", folder.path());
    recording::RawLogReader log(result.folder + "/raw.log");
    double highest = 0;
    double force = 0;
    while (const frame::Frame* frame = log.next()) {
        highest = std::max(highest, frame->bodies[1].X_WB.p.z());
        for (const frame::FingerFrame& finger : frame->fingers)
            force = std::max(force, finger.f_sent_W.norm());
        EXPECT_EQ(frame->status & kOutsideWorkspace, 0u);
    }
    EXPECT_GT(highest - 0.02, 0.095);
    EXPECT_LT(force, 1.4);
    EXPECT_GT(force, 1.0);
}

TEST(Session, SoftFingersHoldARodByItsEndAndLetItSwingWhenTheyEaseOff) {
    const testing::TemporaryFolder folder;
    const RunResult result = run("experiments/swing-rod.yaml", folder.path());
    recording::RawLogReader log(result.folder + "/raw.log");
    // slope of the rod by phase: lift, hold, ease, swing, firm, carry, rest
    std::array<double, 8> most{};
    std::array<double, 8> last{};
    double speed = 0;
    while (const frame::Frame* frame = log.next()) {
        const Vec3 along = frame->bodies[2].X_WB.R * Vec3::UnitY();
        const auto phase = static_cast<size_t>(frame->phase);
        last[phase] = std::asin(-along.z()) * 180 / std::numbers::pi;
        most[phase] = std::max(most[phase], std::abs(last[phase]));
        speed = frame->bodies[2].w_WB.norm();
    }
    EXPECT_LT(most[2], 1);   // held level
    EXPECT_GT(most[4], 80);  // swings
    EXPECT_GT(last[4], 62);  // hangs as steeply as friction permits
    EXPECT_NEAR(last[7], last[4], 2);
    EXPECT_LT(speed, 0.05);
}

TEST(Session, ARealClockSessionReplaysToTheBit) {
    const testing::TemporaryFolder folder;
    const RunResult result = run("scenes/block-on-table.yaml", folder.path(), "", Clock::real);
    EXPECT_GE(result.elapsed, 2.9);
    EXPECT_EQ(result.dropped, 0);
    const ReplayResult replay = replay_session(result.folder, kGoOn, {});
    EXPECT_EQ(replay.ticks, result.ticks);
    EXPECT_EQ(replay.different_ticks, 0) << "first at " << replay.first_difference << " s";
}

/// Rewrites the session's log with changed frames and a changed head.
void rewrite_log(const std::string& folder, const std::function<bool(frame::Frame&)>& change,
                 const std::function<void(recording::LogHead&)>& change_head = {}) {
    const std::string file = folder + "/raw.log";
    fs::rename(file, file + ".old");
    recording::RawLogReader old(file + ".old");
    recording::LogHead head = old.head();
    if (change_head) change_head(head);
    recording::RawLogWriter log(file, head);
    std::vector<std::byte> bytes(recording::most_bytes(head.layout(), 100));
    while (const frame::Frame* recorded = old.next()) {
        frame::Frame frame = *recorded;
        if (!change(frame)) continue;
        const size_t size = recording::encode(frame, bytes, recording::Bodies::all);
        log.add(std::span(bytes).first(size));
    }
    log.finish();
}

TEST(Session, ReplaySeesForcesThatDiffer) {
    const testing::TemporaryFolder folder;
    const RunResult result = run("scenes/frictionless-plane.yaml", folder.path());
    rewrite_log(result.folder, [](frame::Frame& frame) {
        if (frame.sequence >= 100 && frame.sequence < 103) frame.fingers[0].f_sent_W.x() += 1e-15;
        return true;
    });
    const ReplayResult replay = replay_session(result.folder, kGoOn, {});
    EXPECT_EQ(replay.different_ticks, 3);
    EXPECT_NEAR(replay.first_difference, 0.1, 1e-9);
    EXPECT_EQ(replay.ticks, result.ticks);
    EXPECT_FALSE(replay.good());
}

TEST(Session, ReplayRefusesInputsThatWereChangedAndNamesThem) {
    const testing::TemporaryFolder folder;
    const RunResult result = run("scenes/frictionless-plane.yaml", folder.path());
    std::string settings = testing::read_file(result.folder + "/settings.yaml");
    settings.replace(settings.find("stiffness_N_m: 800"), 18, "stiffness_N_m: 801");
    std::ofstream(result.folder + "/settings.yaml") << settings;
    try {
        replay_session(result.folder, kGoOn, {});
        FAIL();
    } catch (const Error& e) {
        ASSERT_EQ(e.problems().size(), 1u);
        EXPECT_EQ(e.problems()[0].place.file, result.folder + "/settings.yaml");
    }
}

TEST(Session, ReplayEndsAtAGapAndSaysWhatIsMissing) {
    const testing::TemporaryFolder folder;
    const RunResult result = run("scenes/frictionless-plane.yaml", folder.path());
    const int64_t ticks = result.ticks;
    rewrite_log(result.folder, [&](frame::Frame& frame) {
        return frame.sequence < 200 || (frame.sequence >= 207 && frame.sequence < ticks - 10);
    });
    const ReplayResult replay = replay_session(result.folder, kGoOn, {});
    EXPECT_EQ(replay.ticks, 200);
    EXPECT_EQ(replay.different_ticks, 0);
    EXPECT_TRUE(replay.damaged);
    ASSERT_EQ(replay.log.size(), 2u);
    EXPECT_EQ(replay.log[0].find("7 ticks missing from tick 200 on"), 0u) << replay.log[0];
    EXPECT_EQ(replay.log[1].find("10 ticks missing at the end"), 0u) << replay.log[1];
}

TEST(Session, ReplayNeedsNoSessionYaml) {
    const testing::TemporaryFolder folder;
    const RunResult result = run("scenes/frictionless-plane.yaml", folder.path());
    fs::remove(result.folder + "/session.yaml");
    double shown = 0;
    const ReplayResult replay =
        replay_session(result.folder, kGoOn, [&](double share) { shown = share; });
    EXPECT_TRUE(replay.good());
    EXPECT_EQ(replay.ticks, result.ticks);
    EXPECT_EQ(replay.warnings.size(), 1u);
    EXPECT_EQ(shown, 1);
}

TEST(Session, FreezesItsInputsSoThatItNeedsNoOtherFile) {
    const testing::TemporaryFolder folder;
    folder.write("block.obj",
                 "v 0 0 0\nv 40 0 0\nv 0 40 0\nv 0 0 40\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n");
    const std::string scene =
        folder.write("scene.yaml",
                     "bodies:\n  - {name: floor, shape: plane, fixed: yes}\n  - {name: thing, "
                     "shape: mesh, file: block.obj, unit: mm, mass_g: 50}\n"
                     "hand: {centre_mm: [0, 0, 100], script: [{name: wait, duration_s: 0.2}]}\n");
    const RunResult result = run(scene, folder.file("out"));
    fs::remove(folder.file("block.obj"));
    fs::remove(scene);
    EXPECT_EQ(replay_session(result.folder, kGoOn, {}).different_ticks, 0);
    const std::string csv = testing::read_file(result.folder + "/settings.csv");
    EXPECT_NE(csv.find("coupling.stiffness_N_m,1000,default"), std::string::npos) << csv;
}

TEST(Session, RecordsWhereEverySettingCameFrom) {
    const testing::TemporaryFolder folder;
    const RunResult result = run("scenes/frictionless-plane.yaml", folder.path(), "",
                                 Clock::virtual_clock, {"dynamics.iterations=99"});
    const std::string csv = testing::read_file(result.folder + "/settings.csv");
    EXPECT_NE(csv.find("coupling.stiffness_N_m,800,scenes/frictionless-plane.yaml:2"),
              std::string::npos)
        << csv;
    EXPECT_NE(csv.find("dynamics.iterations,99,command line"), std::string::npos) << csv;
}

TEST(Session, StopsInOrderWhenAsked) {
    const testing::TemporaryFolder folder;
    Request request;
    request.file = "scenes/frictionless-plane.yaml";
    RunOptions options;
    options.out = folder.path();
    const std::atomic<bool> stop{true};
    const RunResult result = run_session(make_plan(request), options, stop, {});
    EXPECT_TRUE(result.interrupted);
    // the session's other files do not exist yet
    const recording::SessionInfo info = recording::SessionFolder::open(result.folder).read_info();
    EXPECT_EQ(info.state, recording::SessionState::running);
    EXPECT_TRUE(info.interrupted);
    EXPECT_EQ(result.info.state, recording::SessionState::interrupted);
}

TEST(Session, TheOperatorsStopOnTheRealClockIsRecordedAndReplayed) {
    const testing::TemporaryFolder folder;
    Request request;
    request.file = "scenes/block-on-table.yaml";
    RunOptions options;
    options.out = folder.path();
    options.clock = Clock::real;
    std::atomic<bool> stop{false};
    const RunResult result = run_session(make_plan(request), options, stop,
                                         [&](double share) { stop.store(share > 0.2); });
    EXPECT_TRUE(result.interrupted);
    EXPECT_NE(result.fault.find("stopped by the operator"), std::string::npos) << result.fault;
    recording::RawLogReader log(result.folder + "/raw.log");
    frame::Frame last;
    while (const frame::Frame* frame = log.next()) last = *frame;
    EXPECT_NE(last.status & kStopped, 0u);
    EXPECT_EQ(last.fingers[0].f_sent_W, Vec3::Zero());
    EXPECT_TRUE(replay_session(result.folder, kGoOn, {}).good());
}

/// Runs a scene on devices with these options, and replays it. `more` contains additional lines for
/// the rig file.
std::vector<frame::Frame> run_and_replay(const std::string& options, std::vector<std::string> set,
                                         const std::string& more = "") {
    const testing::TemporaryFolder folder;
    Request request;
    request.file = "scenes/block-on-table.yaml";
    request.rig = folder.write(
        "rig.yaml",
        fmt::format("devices:\n  - {{finger: thumb, backend: simulated, options: {0}}}\n"
                    "  - {{finger: index, backend: simulated, options: {0}}}\n{1}",
                    options, more));
    request.set = std::move(set);
    RunOptions run;
    run.out = folder.file("out");
    const RunResult result = run_session(make_plan(request), run, kGoOn, {});
    const ReplayResult replay = replay_session(result.folder, kGoOn, {});
    EXPECT_TRUE(replay.good()) << "first at " << replay.first_difference << " s";
    std::vector<frame::Frame> frames;
    recording::RawLogReader log(result.folder + "/raw.log");
    while (const frame::Frame* frame = log.next()) frames.push_back(*frame);
    return frames;
}

uint32_t status_of(const std::vector<frame::Frame>& frames) {
    uint32_t status = 0;
    for (const frame::Frame& frame : frames) status |= frame.status;
    return status;
}

TEST(Session, ReplaysWhatTheDevicesLimitsAndTheSwitchDid) {
    EXPECT_NE(status_of(run_and_replay("{continuous_force_N: 0.5}", {})) & kHeatLimited, 0u);
    EXPECT_NE(status_of(run_and_replay("{workspace_mm: [80, 80, 80]}", {})) & kPushedInward, 0u);
    const auto held = run_and_replay("{buttons: 2}",
                                     {"safety.dead_man_finger=index", "safety.dead_man_button=1"});
    EXPECT_EQ(status_of(held) & kSwitchedOff, 0u);
    const auto loose = run_and_replay("{buttons: 2}", {"safety.dead_man_finger=index"});
    double force = 0;
    for (const frame::Frame& frame : loose) {
        EXPECT_NE(frame.status & kSwitchedOff, 0u);
        force = std::max(force, frame.fingers[0].f_sent_W.norm());
    }
    EXPECT_EQ(force, 0);
}

TEST(Session, AWallThatIsNotWhereTheWorkIsIsWarnedOf) {
    const testing::TemporaryFolder folder;
    const auto warnings = [&](const char* wall) {
        Request request;
        request.file = "scenes/block-on-table.yaml";
        request.rig = folder.write(
            "rig.yaml", fmt::format("devices:\n  - {{finger: thumb, backend: simulated}}\n"
                                    "  - {{finger: index, backend: simulated}}\nwall: {}\n",
                                    wall));
        std::string out;
        for (const Problem& problem : make_plan(request).warnings) out += problem.text() + "\n";
        return out;
    };
    EXPECT_EQ(warnings("{centre_mm: [0, 0, 100], size_mm: [400, 400, 200]}"), "");
    const std::string high = warnings("{centre_mm: [0, 0, 200], size_mm: [400, 400, 200]}");
    EXPECT_NE(high.find("rig.yaml:4: warning: wall: keeps hands away from the block"),
              std::string::npos)
        << high;
    EXPECT_NE(high.find("pushes the hand back in 100 % of its movement"), std::string::npos)
        << high;
}

TEST(Session, TheRigsWallKeepsHandsInAndReplays) {
    const auto highest = [](const std::vector<frame::Frame>& frames) {
        double height = 0;
        for (const frame::Frame& frame : frames)
            height = std::max(height, frame.fingers[0].p_WH.z());
        return height;
    };
    const auto wide = run_and_replay("{workspace_mm: [600, 600, 600]}", {});
    EXPECT_EQ(status_of(wide) & kPushedInward, 0u);
    // a wall instead of the workspace stated by the devices
    const auto low =
        run_and_replay("{workspace_mm: [600, 600, 600]}", {"safety.workspace_stiffness_N_m=2000"},
                       "wall: {centre_mm: [0, 0, 10], size_mm: [600, 600, 80]}\n");
    EXPECT_NE(status_of(low) & kPushedInward, 0u);
    EXPECT_GT(highest(wide), 0.065);
    EXPECT_LT(highest(low), 0.055);
}

TEST(Session, ReplaysWhatTheEnergyGuardDid) {
    // a dual spring that is much too stiff shakes, so that the guard has to act
    const auto frames =
        run_and_replay("{}", {"coupling.kind=dual_spring", "coupling.stiffness_N_m=4000",
                              "safety.energy_guard=act", "safety.soft_start_s=0"});
    EXPECT_NE(status_of(frames) & kEnergyDamped, 0u);
}

TEST(Session, AFaultEndsItAfterASecond) {
    const auto frames = run_and_replay("{}", {"safety.max_speed_m_s=0.01"});
    const auto first = std::find_if(frames.begin(), frames.end(), [](const frame::Frame& frame) {
        return (frame.status & kForceOff) != 0;
    });
    ASSERT_NE(first, frames.end());
    EXPECT_EQ(frames.back().time - first->time, servo::kGrace);
}

TEST(Session, AnyNumberOfFingersRunsAndReplaysToTheBit) {
    const testing::TemporaryFolder folder;
    for (const auto& [file, fingers] :
         {std::pair{"scenes/bead-on-string.yaml", 1}, std::pair{"scenes/three-fingers.yaml", 3},
          std::pair{"scenes/tools.yaml", 4}}) {
        const RunResult result = run(file, folder.path());
        EXPECT_EQ(result.info.state, recording::SessionState::complete) << file;
        recording::RawLogReader log(result.folder + "/raw.log");
        EXPECT_EQ(log.head().fingers.size(), static_cast<size_t>(fingers));
        EXPECT_TRUE(replay_session(result.folder, kGoOn, {}).good()) << file;
    }
}

TEST(Session, ThreeFingersLiftABlockAndGripItAsEachSideDoes) {
    const testing::TemporaryFolder folder;
    const RunResult result = run("scenes/three-fingers.yaml", folder.path());
    recording::RawLogReader log(result.folder + "/raw.log");
    constexpr double kWeight = 0.15 * 9.81;
    int held = 0;
    while (const frame::Frame* frame = log.next()) {
        if (frame->phase != 2) continue;
        ++held;
        // the springs of the hand and of the couplings yield to the weight
        const double spring = model::series_spring_force(1, 300, 1000);
        EXPECT_NEAR(frame->bodies[1].X_WB.p.z(), 0.08 - kWeight / (3 * spring), 5e-4);
        // while holding, the thumb presses as hard as the other two fingers together
        const auto& f = frame->fingers;
        EXPECT_NEAR(f[0].normal_force, f[1].normal_force + f[2].normal_force, 0.02);
        EXPECT_NEAR(frame->grip_force, f[0].normal_force, 0.02);
        EXPECT_NEAR(frame->load_force, kWeight, 0.02);
        // each of these two presses like springs in series: 300 and 1000 N/m, 7.5 mm beyond touch
        EXPECT_NEAR(f[1].normal_force, f[2].normal_force, 0.02);
        EXPECT_NEAR(f[1].normal_force, model::series_spring_force(0.0075, 300, 1000), 0.02);
    }
    EXPECT_EQ(held, 1000);
}

TEST(Session, AConcaveMeshIsFrozenWithItsPieces) {
    const testing::TemporaryFolder folder;
    const RunResult result = run("scenes/tools.yaml", folder.path());
    EXPECT_TRUE(fs::exists(result.folder + "/mesh-1-cup.obj.pieces"));
    EXPECT_TRUE(fs::exists(result.folder + "/mesh-2-cup.obj.pieces"));
    EXPECT_FALSE(fs::exists(result.folder + "/mesh-3-fingertip.obj.pieces"));
    // the pieces are inputs of the session, just like its meshes
    std::ofstream(result.folder + "/mesh-1-cup.obj.pieces") << "other pieces";
    EXPECT_THROW(replay_session(result.folder, kGoOn, {}), Error);
}

TEST(Session, EachFingerHasTheProxyThatTheSceneGivesIt) {
    const testing::TemporaryFolder folder;
    const RunResult result = run("scenes/tools.yaml", folder.path());
    recording::RawLogReader log(result.folder + "/raw.log");
    double stirred = 0;
    double mug = 0;
    while (const frame::Frame* frame = log.next()) {
        const auto n = static_cast<int>(frame->bodies.size());
        for (const frame::ContactFrame& c : frame->contacts) {
            if (c.a == n + 1 || c.b == n + 1) {
                // a point proxy touches at its own position, but has since moved on by one tick
                EXPECT_LT((c.p_WC - frame->fingers[1].p_WP).norm(), 1e-3);
                EXPECT_EQ(c.points, 1);
                stirred = std::max(stirred, c.normal_force);
            }
        }
        mug = frame->bodies[3].X_WB.p.z();
    }
    EXPECT_GT(stirred, 0.05);
    EXPECT_GT(mug, 0.02);  // the mug hangs on the hook
}

/// Returns the largest change of any sent force between ticks, as a multiple of the largest allowed
/// change.
double worst_force_rate(const std::string& folder) {
    recording::RawLogReader log(folder + "/raw.log");
    const double most = frame::Settings{}.safety.max_force_rate * log.head().tick;
    std::vector<Vec3> last(log.head().fingers.size(), Vec3::Zero());
    double worst = 0;
    while (const frame::Frame* frame = log.next()) {
        for (size_t i = 0; i < last.size(); ++i) {
            worst = std::max(worst, (frame->fingers[i].f_sent_W - last[i]).norm() / most);
            last[i] = frame->fingers[i].f_sent_W;
        }
    }
    return worst;
}

TEST(Movement, TheShippedOneIsGraspedWithoutAForceSpike) {
    const testing::TemporaryFolder folder;
    const RunResult result = run("experiments/reach-to-grasp.yaml", folder.path());
    EXPECT_LE(worst_force_rate(result.folder), 1 + 1e-9);
    EXPECT_TRUE(fs::exists(result.folder + "/movement.csv"));
    EXPECT_TRUE(fs::exists(result.folder + "/movement-faults.csv"));
    recording::RawLogReader log(result.folder + "/raw.log");
    double grip = 0;
    while (const frame::Frame* frame = log.next()) grip = std::max(grip, frame->grip_force);
    EXPECT_GT(grip, 0.5);
}

TEST(Movement, EveryRecordedOneRunsTwiceTheSameAndWithoutAForceSpike) {
    DIHAPTIC_NEEDS_DATA(data, "reach-to-grasp");
    int touched = 0;
    int count = 0;
    for (const auto& entry : fs::directory_iterator(data)) {
        if (entry.path().extension() != ".csv") continue;
        SCOPED_TRACE(entry.path().string());
        const testing::TemporaryFolder folder;
        const RunResult a =
            run("experiments/reach-to-grasp.yaml", folder.path(), entry.path().string());
        const RunResult b =
            run("experiments/reach-to-grasp.yaml", folder.path(), entry.path().string());
        EXPECT_TRUE(testing::read_file(a.folder + "/raw.log") ==
                    testing::read_file(b.folder + "/raw.log"));
        EXPECT_LE(worst_force_rate(a.folder), 1 + 1e-9);
        ++count;
        recording::RawLogReader log(a.folder + "/raw.log");
        double grip = 0;
        while (const frame::Frame* frame = log.next()) grip = std::max(grip, frame->grip_force);
        if (grip > 0.2) ++touched;
    }
    EXPECT_EQ(count, 30);
    EXPECT_GE(touched, 25) << "movements whose fingers met the block on both sides";
}

TEST(Movement, ALineInMetresIsReportedAndBridged) {
    const testing::TemporaryFolder folder;
    std::istringstream in(testing::read_file("movements/reach-to-grasp.csv"));
    std::string line, out;
    for (int n = 1; std::getline(in, line); ++n) {
        if (n == 130)
            line = line.substr(0, line.find(',')) + ",0.035,-0.04,-0.31,0.03,-0.05,-0.35,0";
        out += line + "\n";
    }
    Request request;
    request.file = "experiments/reach-to-grasp.yaml";
    request.movement = folder.write("m.csv", out);
    const Plan plan = make_plan(request);
    ASSERT_FALSE(plan.warnings.empty());
    EXPECT_NE(plan.warnings[0].text().find(
                  "m.csv:130: warning: thumb: this line's values are a thousandth"),
              std::string::npos)
        << plan.warnings[0].text();
}

}  // namespace
}  // namespace dihaptic::session::session_run_test
