#include "session/plan.h"

#include <gtest/gtest.h>

#include <functional>
#include <sstream>

#include "session/check.h"
#include "session/test/reaches.h"
#include "testing/files.h"

namespace dihaptic::session::plan_test {
namespace {

namespace fs = std::filesystem;

/// Returns the shipped files, which tests run and check.
std::vector<std::string> shipped(const std::string& folder, const std::string& extension) {
    std::vector<std::string> out;
    for (const auto& entry : fs::directory_iterator(folder)) {
        if (entry.path().extension() == extension) out.push_back(entry.path().string());
    }
    std::sort(out.begin(), out.end());
    return out;
}

TEST(ShippedFiles, AreInOrder) {
    for (const char* folder :
         {"scenes", "rigs", "experiments", "forms", "populations", "studies"}) {
        for (const std::string& file : shipped(folder, ".yaml")) {
            Diagnostics diagnostics;
            EXPECT_NE(check_file(file, diagnostics).what, "unknown");
            for (const Problem& p : diagnostics.problems()) {
                // simulated people can rehearse a file that requires a judgement they cannot make,
                // if it says so
                const bool arbitrary =
                    p.severity == Severity::warning &&
                    p.text().find("do not treat their figures as human data") != std::string::npos;
                const bool said = testing::read_file(file).find("arbitrary") != std::string::npos;
                EXPECT_TRUE(arbitrary && said) << p.text();
            }
        }
    }
}

TEST(ShippedFiles, TheMovementHasTheFaultsThatItIsToShow) {
    Diagnostics diagnostics;
    EXPECT_EQ(check_file("movements/reach-to-grasp.csv", diagnostics).what, "movement");
    EXPECT_FALSE(diagnostics.has_errors());
    std::string all;
    for (const Problem& p : diagnostics.problems()) all += p.text() + "\n";
    for (const char* fault :
         {"missing frames", "missing marker", "frozen marker", "wild position"}) {
        EXPECT_NE(all.find(fault), std::string::npos) << fault;
    }
}

/// An experiment with its files, and the messages given when it is planned.
struct Files {
    testing::TemporaryFolder folder;
    std::string scene =
        "bodies:\n  - {name: block, shape: box, size_mm: [40, 40, 40], mass_g: 100}\n"
        "settings: {coupling: {stiffness_N_m: 500}}\n";
    std::string rig =
        "devices:\n  - {finger: thumb, backend: simulated}\n  - {finger: index, backend: "
        "simulated}\n"
        "settings: {coupling: {stiffness_N_m: 600}, rate_Hz: 500}\n";
    std::string experiment = "scene: scene.yaml\nrig: rig.yaml\n";

    Request request() {
        folder.write("scene.yaml", scene);
        folder.write("rig.yaml", rig);
        Request out;
        out.file = folder.write("experiment.yaml", experiment);
        return out;
    }
    std::string messages() {
        try {
            std::string all;
            for (const Problem& p : make_plan(request()).warnings) all += p.text() + "\n";
            return all;
        } catch (const Error& e) {
            return e.what();
        }
    }
};

TEST(Plan, SettingsComeFromSceneThenRigThenExperimentThenCommandLine) {
    Files files;
    Plan plan = make_plan(files.request());
    EXPECT_EQ(plan.settings.coupling.stiffness, 600);
    EXPECT_EQ(plan.settings.rate, 500);
    EXPECT_NE(plan.origins["coupling.stiffness"].find("rig.yaml:4"), std::string::npos)
        << plan.origins["coupling.stiffness"];
    files.experiment += "settings: {coupling: {stiffness_N_m: 700}}\n";
    EXPECT_EQ(make_plan(files.request()).settings.coupling.stiffness, 700);
    Request request = files.request();
    request.set = {"coupling.stiffness_N_m=800", "dynamics.solver=sequential_impulse"};
    plan = make_plan(request);
    EXPECT_EQ(plan.settings.coupling.stiffness, 800);
    EXPECT_EQ(plan.origins["coupling.stiffness"], "command line");
}

/// Stiffness and damping given as shares of what a Premium renders calmly: 1000 N/m and 8 N*s/m.
struct SharedFiles : Files {
    SharedFiles() {
        rig =
            "devices:\n"
            "  - {finger: thumb, backend: simulated, options: {preset: premium_1_0}}\n"
            "  - {finger: index, backend: simulated, options: {preset: premium_1_0}}\n";
    }
};

TEST(Plan, StiffnessAndDampingMayBeSharesOfWhatTheDeviceRenders) {
    SharedFiles files;
    files.experiment +=
        "settings: {coupling: {stiffness_share: 0.5, damping_share: 0.1}, proxy: {kind: point}}\n";
    Plan plan = make_plan(files.request());
    EXPECT_EQ(plan.settings.coupling.stiffness, 500);
    EXPECT_EQ(plan.settings.coupling.damping, 0.8);
    // a session stores only the values, not the shares
    EXPECT_FALSE(plan.settings.coupling.stiffness_share);
    EXPECT_FALSE(plan.settings.coupling.damping_share);
    EXPECT_NE(
        plan.origins["coupling.stiffness"].find("experiment.yaml:3 (0.5 of the device's 1000 N/m)"),
        std::string::npos)
        << plan.origins["coupling.stiffness"];
    EXPECT_EQ(plan.origins.count("coupling.stiffness_share"), 0u);
    // the later setting wins, whether it is a value or a share
    Request request = files.request();
    request.set = {"coupling.stiffness_N_m=700"};
    EXPECT_EQ(make_plan(request).settings.coupling.stiffness, 700);
    request.set.emplace_back("coupling.stiffness_share=0.25");
    plan = make_plan(request);
    EXPECT_EQ(plan.settings.coupling.stiffness, 250);
    EXPECT_EQ(plan.origins["coupling.stiffness"], "command line (0.25 of the device's 1000 N/m)");
}

TEST(Plan, ASharesMaximumIsThatOfTheDeviceThatRendersLeast) {
    SharedFiles files;
    files.rig += "  - {finger: middle, backend: simulated, options: {max_stiffness_N_m: 400}}\n";
    files.scene +=
        "fingers: [{name: thumb, shape: sphere, radius_mm: 8}, {name: middle, shape: "
        "sphere, radius_mm: 8}]\nhand: {fingers: [{name: thumb, side: [-1, 0, 0]}, "
        "{name: middle, side: [1, 0, 0]}]}\n";
    files.experiment += "settings: {coupling: {stiffness_share: 0.5}}\n";
    EXPECT_EQ(make_plan(files.request()).settings.coupling.stiffness, 200);
}

TEST(Plan, RefusesSharesThatContradictAreNoneOrAreOfNothing) {
    SharedFiles both;
    both.experiment += "settings: {coupling: {stiffness_share: 0.5, stiffness_N_m: 600}}\n";
    EXPECT_NE(both.messages().find("experiment.yaml:3: error: stiffness_share: the same stiffness "
                                   "is also given as stiffness_N_m. Keep one of the two."),
              std::string::npos)
        << both.messages();
    SharedFiles damping;
    damping.experiment += "settings: {coupling: {damping_Ns_m: 2, damping_share: 0.5}}\n";
    EXPECT_NE(damping.messages().find("the same damping is also given as damping_Ns_m"),
              std::string::npos)
        << damping.messages();
    SharedFiles large;
    large.experiment += "settings: {coupling: {stiffness_share: 1.5}}\n";
    EXPECT_NE(large.messages().find("stiffness_share: must be above 0 and at most 1, but is 1.5"),
              std::string::npos)
        << large.messages();
    Files ideal;
    ideal.experiment += "settings: {coupling: {stiffness_share: 0.5}}\n";
    EXPECT_NE(ideal.messages().find("experiment.yaml:3: error: coupling.stiffness_share: simulated "
                                    "device does not report the largest stiffness that it renders. "
                                    "Give stiffness_N_m under 'coupling', or use another rig."),
              std::string::npos)
        << ideal.messages();
    frame::Settings settings;
    EXPECT_THROW(apply_setting(settings, "coupling.stiffness_share=0.5"), Error);
}

TEST(Plan, WarnsOfTurningStiffnessThatTheLoopCannotHold) {
    Files files;
    files.rig =
        "devices:\n"
        "  - {finger: thumb, backend: simulated, options: {preset: sigma_7}}\n"
        "  - {finger: index, backend: simulated, options: {preset: sigma_7}}\n";
    files.experiment += "settings: {coupling: {turn_stiffness_Nm_rad: 39}}\n";
    EXPECT_EQ(files.messages(), "");
    files.experiment =
        "scene: scene.yaml\nrig: rig.yaml\n"
        "settings: {coupling: {turn_stiffness_Nm_rad: 50}}\n";
    EXPECT_NE(files.messages().find(
                  "warning: coupling.turn_stiffness: 50 N*m/rad is above 40 "
                  "N*m/rad (2 b / T), the highest stiffness at which the hand's damping of 0.02 "
                  "N*m*s/rad is certain to keep simulated sigma.7 calm"),
              std::string::npos)
        << files.messages();
}

TEST(Plan, RefusesTorqueFromADeviceThatDoesNotMeasureOrientation) {
    Files files;
    files.rig = "devices:\n  - {finger: thumb, backend: simulated, options: {peak_torque_Nm: 1}}\n";
    EXPECT_NE(files.messages().find("a device that renders torque must measure orientation. Add "
                                    "orientation: yes, or leave out peak_torque_Nm."),
              std::string::npos)
        << files.messages();
}

TEST(Plan, ASceneAloneRunsOnIdealDevices) {
    Files files;
    files.request();
    Request request;
    request.file = files.folder.file("scene.yaml");
    EXPECT_EQ(make_plan(request).rig.devices.size(), 2u);
}

TEST(Plan, WarnsOfStiffnessThatTheLoopCannotHold) {
    Files files;
    files.experiment += "settings: {coupling: {stiffness_N_m: 9000}, rate_Hz: 1000}\n";
    EXPECT_NE(
        files.messages().find(
            "warning: coupling.stiffness: 9000 N/m is above 6000 N/m (2 b "
            "/ T), the highest stiffness at which the hand's damping of 3 N*s/m is certain to "
            "keep simulated device calm"),
        std::string::npos)
        << files.messages();
    files.experiment =
        "scene: scene.yaml\nrig: rig.yaml\nsettings: {coupling: {stiffness_N_m: 2500}, rate_Hz: "
        "1000}\n";
    EXPECT_EQ(files.messages(), "");
    files.rig.replace(files.rig.find("simulated}"), 10, "simulated, options: {delay_ticks: 1}}");
    EXPECT_NE(files.messages().find("above 2000 N/m"), std::string::npos) << files.messages();
}

TEST(Plan, WarnsOfAnExplicitSpringThatDiverges) {
    Files files;
    files.experiment +=
        "settings: {coupling: {kind: dual_spring, body_mass_g: 1, stiffness_N_m: 4000}, rate_Hz: "
        "1000}\n";
    EXPECT_NE(
        files.messages().find(
            "too stiff for an explicit spring with a proxy of 1 g; the limit is about 1000 N/m"),
        std::string::npos)
        << files.messages();
}

TEST(Plan, WarnsOfAnObjectTooHeavyForTheDevices) {
    Files files;
    files.scene.replace(files.scene.find("mass_g: 100"), 11, "mass_kg: 3");
    EXPECT_NE(files.messages().find("weighs 29.4 N, more than the devices' 17.0 N together"),
              std::string::npos)
        << files.messages();
}

TEST(Plan, SaysWhichWeightsAndSurfacesADeviceCannotRender) {
    Diagnostics diagnostics;
    check_file("experiments/grip-and-lift.yaml", diagnostics, "rigs/premium-pair.yaml");
    EXPECT_FALSE(diagnostics.has_errors());
    std::string said;
    for (const Problem& problem : diagnostics.problems()) said += problem.text() + "\n";
    const size_t for_long = said.find("can sustain");
    const size_t at_most = said.find("8.5 N that simulated Premium 1.0 gives at most");
    ASSERT_NE(for_long, std::string::npos) << said;
    ASSERT_NE(at_most, std::string::npos) << said;
    // W / (2 mu) and W / 2 together, calculated by hand
    EXPECT_GT(said.find("block of 800 g with friction 0.35 (11.9 N)"), at_most) << said;
    EXPECT_LT(said.find("block of 800 g with friction 0.35 (11.9 N)"), for_long) << said;
    EXPECT_NE(said.find("block of 400 g with friction 0.7 (3.4 N)", for_long), std::string::npos);
    EXPECT_EQ(said.find("block of 200 g with friction 1.2"), std::string::npos) << said;  // 1.28 N
}

TEST(Plan, TakesSoftFingersWithEverySolver) {
    Files files;
    files.scene +=
        "fingers:\n"
        "  - {name: thumb, shape: sphere, radius_mm: 8, torsion_radius_mm: 6}\n"
        "  - {name: index, shape: sphere, radius_mm: 8}\n";
    files.scene.replace(files.scene.find("mass_g: 100"), 11, "mass_g: 100, torsion_radius_mm: 3");
    EXPECT_EQ(files.messages(), "");
    files.experiment += "settings: {dynamics: {solver: sequential_impulse}}\n";
    EXPECT_EQ(files.messages(), "");
}

TEST(Plan, SaysThatSweepsDoNotTakeJoints) {
    Files files;
    files.scene += "joints: [{ name: rail, kind: slider, between: [block] }]\n";
    EXPECT_EQ(files.messages(), "");
    files.experiment += "settings: {dynamics: {solver: sequential_impulse}}\n";
    EXPECT_NE(files.messages().find("experiment.yaml:3: warning: dynamics.solver: "
                                    "sequential_impulse does not support joints: newton solves"),
              std::string::npos)
        << files.messages();
}

TEST(Plan, WarnsOfWhatAPointHasNoUseFor) {
    Files files;
    files.experiment += "settings: {proxy: {kind: point}}\n";
    EXPECT_EQ(files.messages(), "");
    files.experiment.replace(
        files.experiment.find("settings:"), std::string::npos,
        "settings: {proxy: {kind: point, friction: apart}, coupling: {kind: dual_spring}}\n");
    files.scene += "fingers: [{name: thumb, shape: sphere, radius_mm: 8, torsion_radius_mm: 6}]\n";
    const std::string said = files.messages();
    EXPECT_NE(said.find("warning: coupling.kind: dual_spring connects handles to rigid proxies"),
              std::string::npos)
        << said;
    EXPECT_NE(said.find("a point carries no moment"), std::string::npos) << said;
}

struct Bad {
    const char* what;
    void (*damage)(Files& files);
    const char* says;
};
void PrintTo(const Bad& bad, std::ostream* out) {
    *out << bad.what;
}
class BadExperiment : public ::testing::TestWithParam<Bad> {};
TEST_P(BadExperiment, IsReported) {
    Files files;
    GetParam().damage(files);
    EXPECT_NE(files.messages().find(GetParam().says), std::string::npos) << files.messages();
}
INSTANTIATE_TEST_SUITE_P(
    Plan, BadExperiment,
    ::testing::Values(
        Bad{"unknown key", [](Files& f) { f.experiment += "raet_Hz: 1\n"; },
            "experiment.yaml:3: error: raet_Hz: is not known here"},
        Bad{"missing scene", [](Files& f) { f.experiment = "title: a\nscene: gone.yaml\n"; },
            "experiment.yaml:2: error: scene: "},
        Bad{"missing rig", [](Files& f) { f.experiment = "scene: scene.yaml\nrig: gone.yaml\n"; },
            "gone.yaml cannot be read: No such file or directory. Check the name and the folder."},
        Bad{"place of a missing rig",
            [](Files& f) { f.experiment = "scene: scene.yaml\nrig: gone.yaml\n"; },
            "experiment.yaml:2: error: rig: "},
        Bad{"rig as scene", [](Files& f) { f.experiment = "scene: rig.yaml\n"; },
            "rig.yaml:1: error: devices: is not known here"},
        Bad{"unknown solver",
            [](Files& f) { f.experiment += "settings: {dynamics: {solver: magic}}\n"; },
            "'magic' is not known. Use sequential_impulse, stewart_trinkle, "
            "staggered_projections"},
        Bad{"unknown finger",
            [](Files& f) { f.experiment += "hand: {fingers: [{name: pinky}]}\n"; },
            "the hand's finger 'pinky' is not among the scene's fingers"},
        Bad{"finger without device",
            [](Files& f) { f.rig = "devices:\n  - {finger: thumb, backend: simulated}\n"; },
            "the scene's finger 'index' holds no device"},
        Bad{"negative duration",
            [](Files& f) { f.experiment += "hand: {script: [{name: a, duration_s: -1}]}\n"; },
            "duration_s: must be positive"},
        Bad{"movement without block",
            [](Files& f) { f.experiment += "movement: {file: m.csv, axes: world}\n"; },
            "block: is missing"},
        Bad{"missing movement",
            [](Files& f) {
                f.experiment += "movement: {file: m.csv, axes: world, block: block}\n";
            },
            "experiment.yaml:3: error: file: "},
        Bad{"an unknown finger's line",
            [](Files& f) { f.experiment += "hand:\n  fingers:\n    - {name: pinky}\n"; },
            "experiment.yaml:5: error: name: the hand's finger"},
        Bad{"a finger without direction",
            [](Files& f) { f.experiment += "hand: {fingers: [{name: thumb, side: [0, 0, 0]}]}\n"; },
            "experiment.yaml:3: error: side: 'thumb' has no direction"},
        Bad{"a finger given twice",
            [](Files& f) {
                f.experiment +=
                    "hand: {fingers: [{name: thumb, side: [1, 0, 0]}, {name: thumb, "
                    "side: [1, 0, 0]}]}\n";
            },
            "experiment.yaml:3: error: name: 'thumb' is given twice"},
        Bad{"tremor's band upside down",
            [](Files& f) { f.experiment += "hand: {tremor: {low_Hz: 20, high_Hz: 10}}\n"; },
            "experiment.yaml:3: error: tremor: its lowest frequency, 20 Hz, is above its highest, "
            "10 Hz"},
        Bad{"negative aperture",
            [](Files& f) {
                f.experiment += "hand: {script: [{name: a, duration_s: 1, aperture_mm: -5}]}\n";
            },
            "aperture_mm: must be at least 0"},
        Bad{"endless duration",
            [](Files& f) { f.experiment += "hand: {script: [{name: a, duration_s: 1e12}]}\n"; },
            "experiment.yaml:3: error: duration_s: must be above 0 and at most 3600, but is 1e12"},
        Bad{"endless script",
            [](Files& f) {
                f.experiment +=
                    "hand: {script: [{name: a, duration_s: 3600}, {name: b, duration_s: 1}]}\n";
            },
            "experiment.yaml:3: error: script: lasts 3601 s, but at most 3600 s are allowed"},
        Bad{"a step of unknown fingers",
            [](Files& f) {
                f.experiment +=
                    "hand:\n  script:\n    - {name: a, duration_s: 1, fingers: [thmub]}\n";
            },
            "experiment.yaml:5: error: fingers: 'a' moves 'thmub', which is not among the "
            "scene's fingers. Known: thumb, index."},
        Bad{"a steady step that ends with another speed",
            [](Files& f) {
                f.experiment +=
                    "hand:\n  script:\n    - {name: a, duration_s: 1, steady: yes, "
                    "end_velocity_m_s: [1, 0, 0]}\n";
            },
            "experiment.yaml:5: error: end_velocity: 'a' is 'steady', so its speed is constant"},
        Bad{"a turn in millimetres",
            [](Files& f) {
                f.experiment +=
                    "hand:\n  script:\n    - {name: a, duration_s: 1, turn_mm: [1, 0, 0]}\n";
            },
            "experiment.yaml:5: error: turn_mm"},
        Bad{"a throw beyond all hands",
            [](Files& f) {
                f.experiment +=
                    "hand:\n  script:\n    - {name: a, duration_s: 1, end_velocity_m_s: [0, 0, "
                    "1200]}\n";
            },
            "experiment.yaml:5: error: end_velocity_m_s: must be"},
        Bad{"a hand too damped to simulate",
            [](Files& f) { f.experiment += "hand: {impedance: {damping_Ns_m: 1e4}}\n"; },
            "experiment.yaml:3: error: impedance: the hand is stiffer or more damped"},
        Bad{"a hand too stiff to simulate",
            [](Files& f) { f.experiment += "hand: {impedance: {stiffness_N_m: 1e9}}\n"; },
            "experiment.yaml:3: error: stiffness_N_m: must be at least 0.001 and at most 100000"},
        Bad{"absurd coupling damping",
            [](Files& f) {
                f.experiment += "settings: {rate_Hz: 1000, coupling: {damping_Ns_m: 1000}}\n";
            },
            "experiment.yaml:3: warning: coupling.damping: 1000 N*s/m is more than a handle of 75 "
            "g can withstand: about 150 N*s/m"},
        Bad{"a force limit beyond the device's",
            [](Files& f) { f.experiment += "settings: {safety: {max_force_N: 20}}\n"; },
            "experiment.yaml:3: warning: safety.max_force: 20 N is more than simulated "
            "device can give: 8.5 N"},
        Bad{"a dead-man switch that no finger has",
            [](Files& f) { f.experiment += "settings: {safety: {dead_man_finger: toe}}\n"; },
            "experiment.yaml:3: error: safety.dead_man_finger: the scene has no finger 'toe'"},
        Bad{"a dead-man button that no device has",
            [](Files& f) { f.experiment += "settings: {safety: {dead_man_button: 32}}\n"; },
            "experiment.yaml:3: error: dead_man_button:"},
        Bad{"an energy guard of a mode that is not known",
            [](Files& f) { f.experiment += "settings: {safety: {energy_guard: maybe}}\n"; },
            "experiment.yaml:3: error: energy_guard:"},
        Bad{"a heating time of no motor",
            [](Files& f) { f.experiment += "settings: {safety: {heating_time_ms: 10}}\n"; },
            "experiment.yaml:3: error: heating_time_ms:"},
        Bad{"a movement without the scene's index",
            [](Files& f) {
                std::istringstream in(testing::read_file("movements/reach-to-grasp.csv"));
                std::string text, line;
                while (std::getline(in, line)) {
                    size_t comma = 0;
                    for (int i = 0; i < 4; ++i) comma = line.find(',', comma) + 1;
                    text += line.substr(0, comma - 1) + "\n";
                }
                f.folder.write("m.csv", text);
                f.experiment += "movement: {file: m.csv, axes: y_up, block: block}\n";
            },
            "m.csv:1: error: index: the movement has no such finger; it has thumb"},
        Bad{"a grasp after the end",
            [](Files& f) {
                f.folder.write("m.csv", testing::read_file("movements/reach-to-grasp.csv"));
                f.experiment +=
                    "movement: {file: m.csv, axes: y_up, block: block, grasp_at_s: 99}\n";
            },
            "99 s is after the movement's end"},
        Bad{"movement's block is no box",
            [](Files& f) {
                f.experiment += "movement: {file: m.csv, axes: world, block: ball}\n";
                f.folder.write("m.csv", "");
            },
            "the scene has no box named 'ball'"}));

TEST(Plan, WarnsOfTrialsThatTheirMeasuresWillNotShow) {
    const auto warnings = [](const std::string& what, const std::string& by) {
        session::Files files;
        files.replace(what, by);
        std::string all;
        for (const Problem& p : make_plan(files.request()).warnings) all += p.text() + "\n";
        return all;
    };
    const std::string usual = warnings("title: Reaches", "title: The same");
    EXPECT_EQ(usual.find("baseline"), std::string::npos) << usual;
    EXPECT_EQ(usual.find("is not measured"), std::string::npos) << usual;
    EXPECT_EQ(warnings("distance_mm: 30", "distance_mm: 50"), usual);
    EXPECT_NE(warnings("kind: baseline", "kind: baseline, perturb: rotation")
                  .find("kind: is baseline, but its trials are perturbed"),
              std::string::npos);
    EXPECT_NE(warnings("distance_mm: 30", "distance_mm: 51")
                  .find("distance: is 51 mm, but the nearest target is 50 mm away"),
              std::string::npos);
    // the value of a formula is not known before the trial
    EXPECT_EQ(warnings("name: target, position_mm: [50, 0, 120]",
                       "name: target, position_mm: [start.x + 50 mm, 0, 120]")
                  .find("is not measured"),
              std::string::npos);
}

TEST(Plan, ReadsFilesWithWordsThatWereReplacedSince) {
    session::Files files;
    files.replace("{ when: time, after_s: 5,", "{ when: time, hold_s: 5,");
    files.replace("simulated_hand: [{ duration_s: 0.2, reach: target",
                  "hand: [{ duration_s: 0.2, reach: target");
    files.replace("  conditions:\n",
                  "  own_measures: [{ name: lift_mm, of: block.z, take: last }]\n  conditions:\n");
    const Plan plan = make_plan(files.request());
    std::string all;
    for (const Problem& p : plan.warnings) all += p.text() + "\n";
    for (const char* said : {"hold_s: is now called after_s. Write after_s.",
                             "hand: is now called simulated_hand. Write simulated_hand.",
                             "own_measures: is now called custom_measures. Write custom_measures."})
        EXPECT_NE(all.find(said), std::string::npos) << said << " is not in\n" << all;
    EXPECT_EQ(plan.task->task.custom_measures.size(), 1u);
    EXPECT_FALSE(plan.task->states[1].hand.empty());
}

TEST(Plan, SetWithoutValueSaysHow) {
    Files files;
    Request request = files.request();
    request.set = {"coupling.stiffness_N_m"};
    EXPECT_THROW(make_plan(request), Error);
}

TEST(Plan, SetIsAnsweredInItsOwnTerms) {
    Files files;
    Request request = files.request();
    const auto said = [&](const std::string& set) -> std::string {
        request.set = {set};
        try {
            make_plan(request);
        } catch (const Error& e) {
            return e.what();
        }
        return "";
    };
    EXPECT_EQ(said("coupling=3"),
              "command line: error: coupling: must have keys of its own. Name one of them: "
              "coupling.KEY=VALUE.");
    EXPECT_EQ(said("coupling.stiffness_N_m=[1"),
              "--set: error: coupling.stiffness_N_m=[1: its value cannot be read. Write --set "
              "coupling.stiffness_N_m=600.");
}

/// Returns the problems that `check` finds in a movement, one per line.
std::string said_of_movement(const std::function<void(std::string&)>& change) {
    const testing::TemporaryFolder folder;
    std::string text = testing::read_file("movements/reach-to-grasp.csv");
    change(text);
    Diagnostics diagnostics;
    check_file(folder.write("m.csv", text), diagnostics);
    std::string all;
    for (const Problem& p : diagnostics.problems()) all += p.text() + "\n";
    return all;
}

TEST(CheckFile, TellsOfFingersOfAMovementThatNobodyKnows) {
    const std::string said = said_of_movement([](std::string& text) {
        for (size_t at = 0; (at = text.find("thumb", at)) != std::string::npos;)
            text.replace(at, 5, "thmub");
    });
    EXPECT_NE(
        said.find("m.csv:1: warning: thmub: is not a usual name for a finger. Did you mean thumb?"),
        std::string::npos)
        << said;
}

TEST(CheckFile, TellsOfAMovementThatIsMostlyBridged) {
    const std::string said = said_of_movement([](std::string& text) {
        // from some point on, keeps only one frame in twelve
        std::istringstream in(text);
        std::string line, thin;
        for (int i = 0; std::getline(in, line); ++i) {
            if (i > 120 && i % 12 != 0) line.replace(line.find(','), std::string::npos, ",,,,,,,0");
            thin += line + "\n";
        }
        text = thin;
    });
    EXPECT_NE(said.find("% of the movement is bridged: more guessed than measured"),
              std::string::npos)
        << said;
    EXPECT_EQ(said.find("nan mm"), std::string::npos) << said;
}

TEST(Plan, WarnsOfAQuestionThatAPersonInAHeadsetDoesNotSee) {
    Files files;
    files.experiment +=
        "task:\n  states:\n    - {name: ask, ask: {name: rated, scale: vas, labels: [soft, hard], "
        "by: mouse}, exits: [{when: answered, outcome: told}]}\n"
        "  blocks: [{name: all, repeats: 1}]\n";
    EXPECT_EQ(files.messages().find("headset"), std::string::npos) << files.messages();
    files.rig += "headset: {space: local}\n";
    EXPECT_NE(files.messages().find("experiment.yaml:5: warning: ask: is not shown in a headset"),
              std::string::npos)
        << files.messages();
}

TEST(Plan, AMovementNeedsAnExperimentThatKnowsWhatToDoWithIt) {
    Files files;
    Request request = files.request();
    request.movement = "movements/reach-to-grasp.csv";
    EXPECT_THROW(make_plan(request), Error);
}

TEST(CheckFile, ReadsPopulations) {
    testing::TemporaryFolder folder;
    Diagnostics diagnostics;
    check_file(folder.write("people.yaml", "title: People\nbased_on: nobody.yaml\n"), diagnostics);
    EXPECT_TRUE(diagnostics.has_errors());
    const std::string adults = fs::absolute("populations/adults.yaml").string();
    const std::string group = "groups:\n  - {name: control, traits: [{trait: nerve, median: 1}]}\n";
    Diagnostics of_trait;
    check_file(folder.write("people.yaml", "title: P\nbased_on: " + adults + "\n" + group),
               of_trait);
    ASSERT_TRUE(of_trait.has_errors());
    EXPECT_NE(of_trait.problems().front().text().find("nerve"), std::string::npos);
}

TEST(CheckFile, SaysWhatItDoesNotKnow) {
    const testing::TemporaryFolder folder;
    Diagnostics diagnostics;
    EXPECT_EQ(check_file(folder.write("x.yaml", "hello: 1\n"), diagnostics).what, "unknown");
    EXPECT_TRUE(diagnostics.has_errors());
}

}  // namespace
}  // namespace dihaptic::session::plan_test
