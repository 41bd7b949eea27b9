#include "experiment/plan.h"

#include <gtest/gtest.h>

#include "testing/files.h"

namespace dihaptic::experiment {
namespace {

namespace fs = std::filesystem;

/// The shipped files, which tests run and check.
std::vector<std::string> shipped(const std::string& folder, const std::string& extension) {
    std::vector<std::string> out;
    for (const auto& entry : fs::directory_iterator(folder)) {
        if (entry.path().extension() == extension) out.push_back(entry.path().string());
    }
    std::sort(out.begin(), out.end());
    return out;
}

TEST(ShippedFiles, AreInOrder) {
    for (const char* folder : {"scenes", "rigs", "experiments"}) {
        for (const std::string& file : shipped(folder, ".yaml")) {
            Diagnostics diagnostics;
            EXPECT_NE(check_file(file, diagnostics), "unknown");
            for (const Problem& p : diagnostics.problems()) ADD_FAILURE() << p.text();
        }
    }
}

TEST(ShippedFiles, TheMovementHasTheFaultsThatItIsToShow) {
    Diagnostics diagnostics;
    EXPECT_EQ(check_file("movements/reach-to-grasp.csv", diagnostics), "movement");
    EXPECT_FALSE(diagnostics.has_errors());
    std::string all;
    for (const Problem& p : diagnostics.problems()) all += p.text() + "\n";
    for (const char* fault :
         {"missing frames", "missing marker", "frozen marker", "wild position"}) {
        EXPECT_NE(all.find(fault), std::string::npos) << fault;
    }
}

/// Messages of planning an experiment with these files beside it.
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
    EXPECT_NE(files.messages().find("warning: coupling.stiffness: 9000 N/m is more than the loop "
                                    "can hold calmly with simulated plant: about 6000 N/m"),
              std::string::npos)
        << files.messages();
    files.experiment =
        "scene: scene.yaml\nrig: rig.yaml\nsettings: {coupling: {stiffness_N_m: 2500}, rate_Hz: "
        "1000}\n";
    EXPECT_EQ(files.messages(), "");
    files.rig.replace(files.rig.find("simulated}"), 10, "simulated, options: {delay_ticks: 1}}");
    EXPECT_NE(files.messages().find("about 2000 N/m"), std::string::npos) << files.messages();
}

TEST(Plan, WarnsOfAnExplicitSpringThatDiverges) {
    Files files;
    files.experiment +=
        "settings: {coupling: {kind: dual_spring, body_mass_g: 1, stiffness_N_m: 4000}, rate_Hz: "
        "1000}\n";
    EXPECT_NE(files.messages().find(
                  "more than an explicit spring can hold with a proxy of 1 g: about 1000 N/m"),
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
        Bad{"missing scene", [](Files& f) { f.experiment = "scene: gone.yaml\n"; },
            "gone.yaml: error: cannot be read"},
        Bad{"missing rig", [](Files& f) { f.experiment = "scene: scene.yaml\nrig: gone.yaml\n"; },
            "gone.yaml: error: cannot be read"},
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
            "no device is held by the scene's finger 'index'"},
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
            "m.csv: error: cannot be read"},
        Bad{"movement's block is no box",
            [](Files& f) {
                f.experiment += "movement: {file: m.csv, axes: world, block: ball}\n";
                f.folder.write("m.csv", "");
            },
            "the scene has no box named 'ball'"}));

TEST(Plan, SetWithoutValueSaysHow) {
    Files files;
    Request request = files.request();
    request.set = {"coupling.stiffness_N_m"};
    EXPECT_THROW(make_plan(request), Error);
}

TEST(Plan, AMovementNeedsAnExperimentThatKnowsWhatToDoWithIt) {
    Files files;
    Request request = files.request();
    request.movement = "movements/reach-to-grasp.csv";
    EXPECT_THROW(make_plan(request), Error);
}

TEST(CheckFile, SaysWhatItDoesNotKnow) {
    const testing::TemporaryFolder folder;
    Diagnostics diagnostics;
    EXPECT_EQ(check_file(folder.write("x.yaml", "hello: 1\n"), diagnostics), "unknown");
    EXPECT_TRUE(diagnostics.has_errors());
}

}  // namespace
}  // namespace dihaptic::experiment
