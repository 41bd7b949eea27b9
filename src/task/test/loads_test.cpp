// Tests loads against closed forms: their laws, zones, delays and profiles, and how bodies move
// under them.
#include "task/effects/load/load.h"

#include <gtest/gtest.h>

#include <numbers>

#include "base/random.h"
#include "recording/raw_log.h"
#include "session/replay.h"
#include "session/test/reaches.h"
#include "task/plan/names.h"
#include "task/run/task_director.h"
#include "testing/allocation_guard.h"

namespace dihaptic::task::loads_test {
namespace {

constexpr double kTick = 1e-3;

/// A load in a scene that has a table, a block and the finger `index`, and regions `start` and
/// `target`.
class OneLoad {
  public:
    explicit OneLoad(const std::string& yaml) {
        Diagnostics diagnostics;
        scene::Scene scene;
        read_fields(scene, parse_yaml(session::kScene, "scene.yaml"), diagnostics);
        LoadSpec spec;
        read_fields(spec, parse_yaml("on: index\n" + yaml, "load.yaml"), diagnostics);
        Task task;
        task.regions = regions_;
        const Names names(task, scene);
        resolve(spec, names, diagnostics);
        load_.emplace(spec, names, scene, diagnostics);
        for (const Problem& problem : diagnostics.problems()) ADD_FAILURE() << problem.text();
    }
    Vec3 force(const Motion& motion, double share = 1) const {
        return load_->act(share, centres_W, motion).force;
    }
    const Load& operator*() const { return *load_; }

    static constexpr double kX = 0.1;
    const std::vector<Vec3> centres_W{{0.01, 0.02, 0.03}, {0.01 + kX, 0.02, 0.03}};
    const Vec3& start_W = centres_W[0];

  private:
    static Region region(const char* name, const Vec3& p_W) {
        return {name, {p_W.x(), p_W.y(), p_W.z()}, 0.01, {}};
    }
    std::vector<Region> regions_{region("start", centres_W[0]), region("target", centres_W[1])};
    std::optional<Load> load_;
};

std::vector<Motion> some_motions() {
    Random random(1, "motions");
    const auto vector = [&](double size) {
        return Vec3(random.uniform(-size, size), random.uniform(-size, size),
                    random.uniform(-size, size));
    };
    std::vector<Motion> out(50);
    for (Motion& motion : out) motion = {vector(0.1), vector(0.5)};
    return out;
}

void expect_same(const OneLoad& a, const OneLoad& b) {
    for (const Motion& motion : some_motions()) {
        for (const double share : {0.0, 0.3, 1.0})
            EXPECT_LT((a.force(motion, share) - b.force(motion, share)).norm(), 1e-12);
    }
}

TEST(Load, AGeneralOneHasTheOthersAsSpecialCases) {
    expect_same(OneLoad("kind: constant\nforce_N: [1, -2, 0.5]"),
                OneLoad("kind: general\nforce_N: [1, -2, 0.5]"));
    expect_same(OneLoad("kind: viscous\ndamping_Ns_m: 7"),
                OneLoad("kind: general\nB_Ns_m: [[-7, 0, 0], [0, -7, 0], [0, 0, -7]]"));
    expect_same(OneLoad("kind: curl\naxis: [0, 0, 2]\ndamping_Ns_m: 13"),
                OneLoad("kind: general\nB_Ns_m: [[0, -13, 0], [13, 0, 0], [0, 0, 0]]"));
    expect_same(OneLoad("kind: spring\nabout: start\nstiffness_N_m: 200\ndamping_Ns_m: 3"),
                OneLoad("kind: general\nabout: start\n"
                        "A_N_m: [[-200, 0, 0], [0, -200, 0], [0, 0, -200]]\n"
                        "B_Ns_m: [[-3, 0, 0], [0, -3, 0], [0, 0, -3]]"));
    const OneLoad line(
        "kind: general\nabout: start\nA_N_mm: [[0, 0, 0], [0, -1, 0], [0, 0, -1]]\n"
        "B_Ns_m: [[0, 0, 0], [0, -5, 0], [0, 0, -5]]");
    expect_same(line, OneLoad("kind: channel\nfrom: start\nto: target\nstiffness_N_m: 1000\n"
                              "damping_Ns_m: 5"));
    expect_same(line, OneLoad("kind: spring\nabout: start\naxis: [3, 0, 0]\nstiffness_N_m: 1000\n"
                              "damping_Ns_m: 5"));
    const OneLoad plane(
        "kind: general\nabout: start\nA_N_m: [[0, 0, 0], [0, -900, 0], [0, 0, 0]]\n"
        "B_Ns_m: [[0, 0, 0], [0, -4, 0], [0, 0, 0]]");
    expect_same(plane, OneLoad("kind: channel\nabout: start\nnormal: [0, -2, 0]\n"
                               "stiffness_N_m: 900\ndamping_Ns_m: 4"));
    expect_same(plane, OneLoad("kind: channel\nfrom: start\nto: target\nfree: [1, 0, 1]\n"
                               "stiffness_N_m: 900\ndamping_Ns_m: 4"));
}

TEST(Load, ACurlFieldDoesNoWorkAndAViscousOneOnlyTakesIt) {
    const OneLoad curl("kind: curl\naxis: [1, 2, 3]\ndamping_Ns_m: 20");
    const OneLoad viscous("kind: viscous\ndamping_Ns_m: 20");
    for (const Motion& motion : some_motions()) {
        EXPECT_NEAR(curl.force(motion).dot(motion.v_W), 0, 1e-12);
        EXPECT_LT(viscous.force(motion).dot(motion.v_W), 0);
    }
}

TEST(Load, AOneSidedPlaneIsAWallThatPushesAndNeverHolds) {
    const OneLoad wall(
        "kind: spring\nabout: start\nnormal: [0, 0, 1]\none_sided: yes\n"
        "stiffness_N_m: 500\ndamping_Ns_m: 10");
    const auto force_at = [&](double z, double v) {
        return wall.force({wall.start_W + Vec3(0.02, 0.01, z), {0.1, 0, v}});
    };
    EXPECT_EQ(force_at(0.001, -0.1), Vec3::Zero());
    EXPECT_LT((force_at(-0.004, 0) - Vec3(0, 0, 2)).norm(), 1e-12);
    EXPECT_LT((force_at(-0.004, -0.1) - Vec3(0, 0, 3)).norm(), 1e-12);
    EXPECT_EQ(force_at(-0.004, 0.3), Vec3::Zero());  // otherwise, the load's damper would pull
}

TEST(Load, FadesToZeroBeyondItsZone) {
    const OneLoad away(
        "kind: spring\nabout: start\nstiffness_N_m: -100\nsafe_within_mm: 30\n"
        "fade_mm: 20");
    const OneLoad general(
        "kind: general\nabout: start\nsafe_within_mm: 30\nfade_mm: 20\n"
        "A_N_m: [[100, 0, 0], [0, 100, 0], [0, 0, 100]]");
    const OneLoad channel(
        "kind: channel\nfrom: start\nto: target\nstiffness_N_m: 100\n"
        "break_out_mm: 30\nfade_mm: 20");
    const auto at = [&](const OneLoad& load, double y) {
        return load.force({load.start_W + Vec3(0, y, 0), Vec3::Zero()}).y();
    };
    for (const double y : {-0.06, -0.04, -0.03, -0.01, 0.01, 0.03, 0.04, 0.06}) {
        const double left = std::clamp(1 - (std::abs(y) - 0.03) / 0.02, 0.0, 1.0);
        EXPECT_NEAR(at(away, y), 100 * y * left, 1e-12);
        EXPECT_NEAR(at(general, y), 100 * y * left, 1e-12);
        EXPECT_NEAR(at(channel, y), -100 * y * left, 1e-12);
    }
    EXPECT_NEAR((*away).demand().force, 3, 1e-12);
    EXPECT_NEAR((*away).demand().stiffness, 150, 1e-9);  // due to fading: 3 N over 20 mm
}

TEST(Load, SaysWhatItAsksOfALoop) {
    const OneLoad general(
        "kind: general\nabout: start\n"
        "A_N_m: [[-300, 0, 0], [0, -100, 0], [0, 0, 0]]\n"
        "B_Ns_m: [[0, -13, 0], [13, 0, 0], [0, 0, 2]]");
    const Load::Demand demand = (*general).demand();
    EXPECT_NEAR(demand.stiffness, 300, 1e-9);
    EXPECT_NEAR(demand.damping, 13, 1e-9);
    EXPECT_NEAR(demand.driving, 2, 1e-9);
    EXPECT_TRUE(std::isinf(demand.force));
    EXPECT_NEAR(
        (*OneLoad("kind: constant\nforce_N: [3, 0, 4]\ntorque_mNm: [0, 0, 20]")).demand().torque,
        0.02, 1e-12);
    EXPECT_EQ((*OneLoad("kind: curl\naxis: [0, 0, 1]\ndamping_Ns_m: -13")).demand().driving, 0);
    EXPECT_EQ((*OneLoad("kind: viscous\ndamping_Ns_m: -13")).demand().driving, 13);
}

TEST(Profile, RisesStaysAndFallsAndItsIntegralIsThatOfATrapezium) {
    for (const ProfileShape shape : {ProfileShape::linear, ProfileShape::minimum_jerk}) {
        Profile profile;
        profile.delay = 0.1;
        profile.rise = 0.02;
        profile.plateau = 0.08;
        profile.fall = 0.04;
        profile.shape = shape;
        double sum = 0;
        for (int i = 0; i < 400; ++i) {
            const double share = profile.share(i * kTick);
            EXPECT_GE(share, 0);
            EXPECT_LE(share, 1);
            sum += share * kTick;
        }
        EXPECT_NEAR(sum, 0.02 / 2 + 0.08 + 0.04 / 2, 1e-6);  // the ramps are symmetric
        EXPECT_EQ(profile.share(0.099), 0);
        EXPECT_NEAR(profile.share(0.11), 0.5, 1e-6);
        EXPECT_EQ(profile.share(0.15), 1);
        EXPECT_NEAR(profile.share(0.22), 0.5, 1e-6);
        EXPECT_EQ(profile.share(0.3), 0);
    }
    EXPECT_EQ(Profile{}.share(0), 1);
    EXPECT_EQ(Profile{}.share(1e6), 1);
    Profile step;
    step.delay = 0.3;  // because of rounding, 0.1 + 0.2 is more than 0.3
    step.plateau = 0.1;
    EXPECT_EQ(step.share(0.1 + 0.2 - kTick), 0);
    EXPECT_EQ(step.share(0.1 + 0.2), 1);
    EXPECT_EQ(step.share(0.4 - kTick), 1);
    EXPECT_EQ(step.share(0.4), 0);
}

TEST(Motions, KeepWhatWasADelayAgo) {
    Motions motions(1, 1, 0.01, kTick);
    frame::Frame last;
    last.bodies.resize(1);
    last.sequence = -1;
    std::vector<frame::Handle> handles(1);
    const auto tick = [&](int i) {
        last.bodies[0].X_WB.p.x() = -i;
        handles[0].p_WH.x() = i;
        motions.add(last, handles);
    };
    tick(1);
    EXPECT_EQ(motions.of(0, 0), nullptr);  // no body is known before the first Frame
    EXPECT_EQ(motions.of(1, 0)->p_W.x(), 1);
    last.sequence = 0;
    for (int i = 2; i <= 30; ++i) {
        tick(i);
        EXPECT_EQ(motions.of(1, 0)->p_W.x(), i);
        EXPECT_EQ(motions.of(1, 0.01)->p_W.x(), std::max(1, i - 10));
        EXPECT_EQ(motions.of(0, 0.004)->p_W.x(), -std::max(2, i - 4));
    }
    motions.put(0, {7, 0, 0});
    EXPECT_EQ(motions.of(0, 0)->p_W.x(), 7);
    EXPECT_EQ(motions.of(0, 0.01)->p_W.x(), 7);
    EXPECT_EQ(motions.of(1, 0.01)->p_W.x(), 20);
    tick(31);
    EXPECT_EQ(motions.of(0, 0.001)->p_W.x(), 7);
    motions.forget();
    EXPECT_EQ(motions.of(1, 0), nullptr);
}

/// A block in the air, 0.5 m up in the region `there`, and the states of one trial in which the
/// listed `perturbations` act.
struct InTheAir : session::Files {
    explicit InTheAir(
        const std::string& perturbations, const std::string& perturb,
        const std::string& states =
            "    - { name: fly, exits: [{ when: time, after_s: 0.4, outcome: done }], "
            "simulated_hand: [{ duration_s: 0.4 }] }\n") {
        scene.replace(scene.find("position_mm: [0, 0, 20]"), 23, "position_mm: [200, 0, 500]");
        experiment =
            "title: In the air\nscene: scene.yaml\nhand: { centre_mm: [0, 0, 120] }\ntask:\n"
            "  regions: [{ name: there, position_mm: [200, 0, 500] }]\n"
            "  perturbations:\n" +
            perturbations + "  states:\n" + states +
            "  blocks: [{ name: all, kind: perturbed, perturb: " + perturb + " }]\n";
    }
    /// Returns the frames of the trial, except its last frame, in which no perturbation acts any
    /// more.
    std::vector<frame::Frame> run() {
        const session::RunResult result = Files::run(session::make_plan(request()));
        std::vector<frame::Frame> out;
        recording::RawLogReader log(result.folder + "/raw.log");
        while (const frame::Frame* frame = log.next()) {
            if (frame->trial == 1 && frame->task.outcome < 0) out.push_back(*frame);
        }
        EXPECT_TRUE(session::replay_session(result.folder, session::kGoOn, {}).good());
        return out;
    }
};

constexpr double kMass = 0.1;
constexpr double kGravity = 9.81;

TEST(Load, ABodyOnASpringOscillatesWithItsPeriod) {
    InTheAir files(
        "    - { name: spring, loads: [{ kind: spring, on: block, about: there, "
        "stiffness_N_m: 100 }] }\n",
        "spring");
    const double sag = kMass * kGravity / 100;
    const double rate = std::sqrt(100 / kMass);  // corresponds to a period of 0.2 s
    double t = 0;
    const std::vector<frame::Frame> frames = files.run();
    for (const frame::Frame& frame : frames) {
        t += kTick;
        EXPECT_NEAR(frame.bodies[1].X_WB.p.z(), 0.5 - sag * (1 - std::cos(rate * t)), 0.03 * sag);
    }
    EXPECT_GT(rate * t, 3 * std::numbers::pi);
}

TEST(Load, ALinkPullsBothOfItsEndsAlike) {
    for (const std::string acts : {"both", "pulls", "pushes"}) {
        SCOPED_TRACE(acts);
        InTheAir files(
            "    - { name: tie, loads: [{ kind: link, between: [index, block], stiffness_N_m: 30, "
            "damping_Ns_m: 0.4, length_mm: 380, acts: " +
                acts + " }] }\n",
            "tie");
        const std::vector<frame::Frame> frames = files.run();
        ASSERT_GT(frames.size(), 300u);
        int acted = 0;
        for (size_t i = 1; i < frames.size(); ++i) {
            const frame::FingerFrame& a = frames[i].fingers[0];
            const frame::BodyFrame& b = frames[i - 1].bodies[1];
            const Vec3 d = a.p_WH - b.X_WB.p;
            const Vec3 u = d.normalized();
            const double stretch = d.norm() - 0.38;
            double pull = 30 * stretch + 0.4 * (a.v_WH - b.v_WB).dot(u);
            if (acts == "pulls") pull = stretch > 0 ? std::max(pull, 0.0) : 0;
            if (acts == "pushes") pull = stretch < 0 ? std::min(pull, 0.0) : 0;
            Vec3 of_finger = Vec3::Zero();
            Vec3 of_block = Vec3::Zero();
            for (const frame::LoadFrame& load : frames[i].task.loads)
                (load.body == 1 ? of_block : of_finger) += load.force_W;
            EXPECT_LT((of_finger + pull * u).norm(), 1e-9) << i;
            EXPECT_LT((of_finger + of_block).norm(), 1e-12) << i;
            acted += pull != 0 ? 1 : 0;
        }
        EXPECT_GT(acted, 30);
    }
}

TEST(Load, ATorqueTurnsABodyByItsInertia) {
    InTheAir files(
        "    - { name: twist, loads: [{ kind: constant, on: block, torque_mNm: [0, 0, 1], "
        "force_N: [0, 0, 0.981] }] }\n",
        "twist");
    const double inertia = kMass * 0.04 * 0.04 / 6;
    double t = 0;
    for (const frame::Frame& frame : files.run()) {
        t += kTick;
        EXPECT_NEAR(frame.bodies[1].w_WB.z(), 1e-3 / inertia * t, 1e-6);
        EXPECT_NEAR(frame.bodies[1].X_WB.p.z(), 0.5,
                    1e-9);  // the force supports the weight of the block
    }
    EXPECT_GT(t, 0.35);
}

TEST(Load, ATorqueOnAHandleIsAddedToTheCouplings) {
    InTheAir files(
        "    - { name: twist, loads: [{ kind: constant, on: index, torque_mNm: [0, 0, 20] "
        "}] }\n",
        "twist");
    files.experiment += "rig: rig.yaml\nsettings: { safety: { soft_start_s: 0 } }\n";
    files.folder.write(
        "rig.yaml",
        "devices: [{ finger: index, backend: simulated, options: { preset: sigma_7 } "
        "}]\n");
    const std::vector<frame::Frame> frames = files.run();
    ASSERT_GT(frames.size(), 300u);
    for (size_t i = 10; i < frames.size(); ++i) {
        const frame::TurnFrame& turn = frames[i].turns.at(0);
        EXPECT_LT((turn.t_sent_W - turn.t_asked_W - Vec3(0, 0, 0.02)).norm(), 1e-12) << i;
    }
    // the hand holds the handle with a stiffness of 1 N*m/rad
    EXPECT_NEAR(rotation_vector(frames.back().turns[0].R_WH).z(), 0.02, 2e-3);
}

TEST(Load, ADelayedOneIsTheUndelayedShifted) {
    InTheAir files(
        "    - name: both\n"
        "      loads:\n"
        "        - { kind: viscous, on: block, damping_Ns_m: 0.1 }\n"
        "        - { kind: viscous, on: block, damping_Ns_m: 0.1, delay_ms: 25 }\n",
        "both");
    const std::vector<frame::Frame> frames = files.run();
    ASSERT_GT(frames.size(), 300u);
    for (size_t i = 25; i < frames.size(); ++i) {
        ASSERT_EQ(frames[i].task.loads.size(), 2u);
        EXPECT_EQ(frames[i].task.loads[1].force_W, frames[i - 25].task.loads[0].force_W) << i;
    }
    EXPECT_GT(frames[250].task.loads[0].force_W.norm(), 0.1);
}

TEST(Perturbation, APulseFollowsItsProfileAcrossStatesAndNoOthers) {
    const std::string state = "exits: [{ when: time, after_s: 0.1, ";
    InTheAir files(
        "    - name: pulse\n"
        "      during: [second, third]\n"
        "      profile: { delay_ms: 50, rise_ms: 20, plateau_ms: 60, fall_ms: 40 }\n"
        "      loads: [{ kind: constant, on: [block, index], force_N: [2, 0, 0] }]\n"
        "    - { name: heavier, during: third, body: { body: block, weight_scale: 2 } }\n"
        "    - { name: rougher, body: { body: block, weight_scale: 3, friction_scale: 0.5 } }\n",
        "[pulse, heavier, rougher]",
        "    - { name: first, simulated_hand: [{ duration_s: 0.1 }], " + state +
            "to: second }] }\n" + "    - { name: second, " + state + "to: third }] }\n" +
            "    - { name: third, " + state + "to: fourth }] }\n" +
            "    - { name: fourth, perturbed: no, " + state + "outcome: done }] }\n");
    Profile profile;
    profile.delay = 0.05;
    profile.rise = 0.02;
    profile.plateau = 0.06;
    profile.fall = 0.04;
    int ticks = 0;  // number of ticks since the second state was entered
    double impulse = 0;
    for (const frame::Frame& frame : files.run()) {
        const bool acts = frame.phase == 2 || frame.phase == 3;
        const double share = acts ? profile.share(kTick * ticks) : 0;
        ticks += acts;
        ASSERT_EQ(frame.task.loads.size(), share > 0 ? 2u : 0u) << frame.phase << " " << ticks;
        if (share > 0) {
            EXPECT_EQ(frame.task.loads[0].body, 1);
            EXPECT_EQ(frame.task.loads[1].body, 2);  // the handle
            EXPECT_NEAR(frame.task.loads[1].force_W.x(), 2 * share, 1e-9);
            impulse += frame.task.loads[1].force_W.x() * kTick;
        }
        ASSERT_EQ(frame.task.properties.size(), frame.phase == 4 ? 0u : 1u);
        if (frame.phase == 4) continue;
        EXPECT_EQ(frame.task.properties[0].weight_scale, frame.phase == 3 ? 6 : 3);
        EXPECT_EQ(frame.task.properties[0].friction_scale, 0.5);
        EXPECT_EQ(frame.task.share, 1);
    }
    EXPECT_EQ(ticks, 200);
    EXPECT_NEAR(impulse, 2 * 0.09, 1e-3);
}

TEST(Perturbation, SeveralActTogetherAndAreToldApartInTheListOfTrials) {
    session::Files files;
    files.replace("perturb: rotation, repeats: 2, ramp: 2",
                  "perturb: [rotation, channel], repeats: 2, ramp: 2");
    const session::Plan plan = session::make_plan(files.request());
    const session::RunResult result = files.run(plan);
    recording::RawLogReader log(result.folder + "/raw.log");
    int both = 0;
    while (const frame::Frame* frame = log.next()) {
        if (frame->trial < 1) continue;
        const Trial& trial = plan.task->trials[static_cast<size_t>(frame->trial) - 1];
        if (frame->phase != 2 || trial.perturb.size() != 2 || frame->task.outcome >= 0) continue;
        ASSERT_EQ(frame->task.visual.size(), 1u);
        ASSERT_EQ(frame->task.loads.size(), 1u);
        EXPECT_EQ(frame->task.share, trial.share);
        const double angle = rotation_vector(frame->task.visual[0].R).z();
        EXPECT_NEAR(angle, trial.share * 30 * kDegree, 1e-9);
        ++both;
    }
    EXPECT_GT(both, 100);
    const std::string file = result.folder + "/trial-list.csv";
    const CsvFile list(file);
    EXPECT_EQ(list.text(2, "perturbation"), "rotation + channel");
    EXPECT_EQ(list.text(7, "perturbation"), "clamp");
    const std::vector<Trial> read = read_trial_list(plan.task->task, file);
    ASSERT_EQ(read.size(), plan.task->trials.size());
    for (size_t i = 0; i < read.size(); ++i)
        EXPECT_EQ(read[i].perturb, plan.task->trials[i].perturb) << i;
    EXPECT_TRUE(names_perturbation("rotation + channel", "channel"));
    EXPECT_TRUE(names_perturbation("a + b", "a + b"));
    EXPECT_FALSE(names_perturbation("rotation + channel", "chan"));
    EXPECT_FALSE(names_perturbation("", "channel"));
    EXPECT_TRUE(session::replay_session(result.folder, session::kGoOn, {}).good());
}

TEST(Perturbation, LoadsOfEveryKindWithDelaysAndProfilesAllocateNothing) {
    DIHAPTIC_NEEDS_ALLOCATION_GUARD();
    InTheAir files(
        "    - name: all\n"
        "      profile: { delay_ms: 10, rise_ms: 20, plateau_ms: 100, fall_ms: 20, shape: "
        "minimum_jerk }\n"
        "      loads:\n"
        "        - { kind: constant, on: [block, index], force_N: [0.1, 0, 0] }\n"
        "        - { kind: viscous, on: index, damping_Ns_m: 1, delay_ms: 30 }\n"
        "        - { kind: curl, on: block, axis: [0, 0, 1], damping_Ns_m: 0.1 }\n"
        "        - { kind: general, on: block, about: there, A_N_m: [[-9, 0, 0], [0, -9, 0], [0, "
        "0, "
        "-9]], delay_ms: 5 }\n"
        "        - { kind: spring, on: block, about: there, stiffness_N_m: -9, safe_within_mm: 30 "
        "}\n"
        "        - { kind: channel, on: index, about: there, normal: [0, 0, 1], stiffness_N_m: 1 "
        "}\n"
        "    - { name: more, body: { body: block, weight_scale: 2 } }\n",
        "[all, more]");
    const session::Plan plan = session::make_plan(files.request());
    const auto servo = session::make_servo(plan);
    TaskDirector task(*plan.task, plan.seed, plan.settings.tick());
    plan.seeing->restart();
    servo->activate();
    const frame::Director director =
        [&](const frame::Frame& last, std::span<const frame::Handle> handles,
            frame::Commands& commands) { task(last, handles, commands); };
    Time now{0};
    size_t most = 0;
    const testing::AllocationGuard guard;
    while (!servo->stopped() && seconds(now) < 5) {
        const frame::Frame& frame = servo->tick(now, director);
        most = std::max(most, frame.task.loads.size());
        plan.seeing->see(frame);
        now += servo->period();
    }
    EXPECT_EQ(guard.count(), 0u);
    EXPECT_EQ(most, 7u);
    EXPECT_EQ(task.share(), 1);
}

}  // namespace
}  // namespace dihaptic::task::loads_test
