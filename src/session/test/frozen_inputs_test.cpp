// Tests that a session uses the files in its own folder: if a file was changed after it had been
// read, the session must not start, and must not leave a folder.
#include <sndfile.h>

#include <filesystem>
#include <random>

#include "analysis/recovery.h"
#include "base/image.h"
#include "base/number.h"
#include "session/resume.h"
#include "session/test/sessions.h"

namespace dihaptic::session::frozen_inputs_test {
namespace {

namespace fs = std::filesystem;

const char* const kMesh =
    "mtllib parts.mtl\nv 0 0 0\nv 20 0 0\nv 0 20 0\nv 0 0 20\nusemtl one\n"
    "f 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";

const char* const kBodies = R"(bodies:
  - { name: table, shape: box, size_mm: [600, 400, 50], position_mm: [0, 0, -25], fixed: yes,
      picture: { file: wood.png, width_mm: 50 } }
  - { name: block, shape: box, size_mm: [40, 40, 40], mass_g: 100, position_mm: [0, 0, 20],
      surface: { texture: { kind: picture, file: relief.png, wavelength_mm: 8, height_mm: 0.1 } } }
  - { name: felt, shape: mesh, file: felt/a.obj, unit: mm, position_mm: [100, 0, 0], fixed: yes }
  - { name: s, shape: sphere, radius_mm: 10, position_mm: [200, 0, 10], fixed: yes,
      seen: { file: seen/a.obj, unit: mm } }
fingers:
  - { name: index, shape: sphere, radius_mm: 6, mass_g: 1 }
)";

/// A study that uses at least one file of each kind.
struct Study : Sessions {
    static constexpr const char* kFiles[] = {"felt/a.obj",     "felt/parts.mtl", "seen/a.obj",
                                             "seen/parts.mtl", "wood.png",       "relief.png",
                                             "page.png",       "click.wav"};

    Study() {
        const testing::TemporaryFolder& folder = files.folder;
        for (const char* name : {"felt", "seen"}) {
            fs::create_directory(folder.file(name));
            folder.write(std::string(name) + "/a.obj", kMesh);
            folder.write(std::string(name) + "/parts.mtl", "newmtl one\nKd 1 0 0\n");
        }
        for (const char* name : {"wood.png", "relief.png", "page.png"})
            write_png(Image{8, 8, std::vector<uint8_t>(192, 90)}, folder.file(name));
        write_click(folder.file("click.wav"));
        files.scene = kBodies;
        files.keep_first_block();
        files.replace("  states:\n", "  sounds: [{ name: click, file: click.wav }]\n  states:\n");
        files.replace("marker: 7\n", "marker: 7\n      sounds: click\n");
        files.replace("repeats: 1 }", "repeats: 1, pages: [{ picture: page.png, for_s: 0.1 }] }");
    }

    static void write_click(const std::string& name) {
        SF_INFO info{};
        info.samplerate = 48000;
        info.channels = 1;
        info.format = SF_FORMAT_WAV | SF_FORMAT_PCM_16;
        SNDFILE* const file = sf_open(name.c_str(), SFM_WRITE, &info);
        const std::vector<float> click{0.0f, 0.9f, -0.9f, 0.9f};
        sf_writef_float(file, click.data(), static_cast<sf_count_t>(click.size()));
        sf_close(file);
    }
};

/// Changes a file in the way that an editor, an exporter or a synchronisation program does.
void change(const std::string& file, int how, std::mt19937_64& random) {
    std::string text = testing::read_file(file);
    const size_t at = random() % text.size();
    if (how == 0) text[at] = static_cast<char>(text[at] ^ (1 << (random() % 7)));
    if (how == 1) text.resize(at);
    if (how == 2) text += text.substr(at);
    fs::remove(file);
    if (how == 3) return;
    if (how == 4) {
        fs::create_directory(file);
        return;
    }
    std::ofstream(file, std::ios::binary) << text;
}

/// Starts the plan, checks that no session folder is left, and returns the error.
std::string refusal(Files& files, const Plan& plan) {
    std::string said = "nothing";
    try {
        files.run(plan);
    } catch (const Error& e) {
        said = e.what();
    }
    const std::string sessions = files.folder.file("sessions");
    EXPECT_TRUE(!fs::exists(sessions) || fs::is_empty(sessions)) << said;
    fs::remove_all(sessions);
    return said;
}

TEST(FrozenInputs, AStudyThatStaysAsItWasIsRun) {
    Study study;
    const RunResult result = study.files.run(study.plan(Mover::script));
    const auto inputs = recording::SessionFolder::open(result.folder).read_info().inputs;
    EXPECT_EQ(inputs.size(), std::size(Study::kFiles) + 5);  // scene, rig, settings, task, list
}

TEST(FrozenInputs, AFileThatWasChangedAfterItWasReadEndsTheStart) {
    std::mt19937_64 random(1);
    for (const char* name : Study::kFiles) {
        for (int how = 0; how < 5; ++how) {
            SCOPED_TRACE(std::string(name) + " " + number_text(how));
            Study study;
            const Plan plan = study.plan(Mover::script);
            change(study.files.folder.file(name), how, random);
            const std::string said = refusal(study.files, plan);
            EXPECT_NE(said.find(name), std::string::npos) << said;
            EXPECT_NE(said.find(how < 3 ? "has changed while it was read" : "cannot be copied"),
                      std::string::npos)
                << said;
        }
    }
}

TEST(FrozenInputs, ARecordedMovementThatWasChangedEndsTheStart) {
    Request request;
    const testing::TemporaryFolder folder;
    request.file = "experiments/reach-to-grasp.yaml";
    request.movement = folder.file("movement.csv");
    std::string text;
    for (const auto& entry : fs::directory_iterator("movements")) {
        if (entry.path().extension() != ".csv") continue;
        request.movement = folder.write("movement.csv", testing::read_file(entry.path().string()));
        break;
    }
    const Plan plan = make_plan(request);
    std::ofstream(request.movement, std::ios::app) << "\n";
    Files files;
    const std::string said = refusal(files, plan);
    EXPECT_NE(said.find("movement.csv: error: has changed while it was read"), std::string::npos)
        << said;
}

TEST(FrozenInputs, TheTablesOfASessionThatIsResumedAreThoseThatWereRead) {
    Sessions sessions;
    const std::string cut = sessions.make(Mover::script, true);
    const Plan plan = rest_of(cut, Seat::terminal, {}).plan;
    std::ofstream(cut + "/trials.csv", std::ios::app) << "\n";
    std::string said;
    try {
        sessions.files.run(plan);
    } catch (const Error& e) {
        said = e.what();
    }
    EXPECT_NE(said.find("trials.csv: error: has changed while it was read"), std::string::npos)
        << said;
}

TEST(FrozenInputs, AChangedTableOfASessionIsNotResumed) {
    Sessions sessions;
    const std::string cut = sessions.make(Mover::script, true);
    std::string text = testing::read_file(cut + "/trials.csv");
    const size_t last = text.rfind('\n', text.size() - 2);
    std::ofstream(cut + "/trials.csv", std::ios::binary) << text.substr(0, last + 1);
    std::string said;
    try {
        rest_of(cut, Seat::terminal, {});
    } catch (const Error& e) {
        said = e.what();
    }
    EXPECT_NE(said.find("trials.csv: error: has "), std::string::npos) << said;
    EXPECT_NE(said.find("when the session ended. Rebuild it from raw.log: dihaptic recover"),
              std::string::npos)
        << said;
    // the window nevertheless offers to continue the session, and then shows this message
    EXPECT_EQ(find_unfinished(sessions.files.folder.file("sessions"), "Reaches", "S07").size(), 1u);
    analysis::recover_session(recording::SessionFolder::open(cut), {});
    EXPECT_NO_THROW(rest_of(cut, Seat::terminal, {}));
    EXPECT_EQ(testing::read_file(cut + "/trials.csv"), text);
}

}  // namespace
}  // namespace dihaptic::session::frozen_inputs_test
