// Tests that a session keeps the appearance of its bodies, even when it is resumed.
#include <algorithm>
#include <filesystem>

#include "base/image.h"
#include "session/resume.h"
#include "session/test/sessions.h"

namespace dihaptic::session::frozen_looks_test {
namespace {

namespace fs = std::filesystem;

/// Writes an OBJ file with one material, whose colour is defined in the file next to it, under a
/// name that is the same in all folders.
void write_mesh(const fs::path& folder, const std::string& colour) {
    fs::create_directory(folder);
    std::ofstream(folder / "a.obj") << "mtllib parts.mtl\nv 0 0 0\nv 20 0 0\nv 0 20 0\nv 0 0 20\n"
                                       "usemtl one\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";
    std::ofstream(folder / "parts.mtl") << "newmtl one\nKd " << colour << "\n";
}

/// Returns the names of those files in a session that define how bodies look.
std::vector<std::string> kept(const std::string& session) {
    std::vector<std::string> out;
    for (const recording::InputFile& input :
         recording::SessionFolder::open(session).read_info().inputs) {
        const std::string ending = fs::path(input.file).extension().string();
        if (ending == ".obj" || ending == ".mtl" || ending == ".png") out.push_back(input.file);
    }
    std::sort(out.begin(), out.end());
    return out;
}

void expect_looks(const std::string& session) {
    Diagnostics diagnostics;
    const scene::Scene scene = scene::read_scene(session + "/scene.yaml", diagnostics);
    for (const Problem& problem : diagnostics.problems()) ADD_FAILURE() << problem.text();
    ASSERT_EQ(scene.bodies.size(), 6u);
    const auto colours = [](const scene::Mesh& mesh) {
        return std::vector<int32_t>(mesh.colours.begin(), mesh.colours.begin() + 1);
    };
    EXPECT_EQ(colours(*scene.bodies[2].shape.coloured), std::vector<int32_t>{0xff0000});
    EXPECT_EQ(colours(*scene.bodies[3].shape.coloured), std::vector<int32_t>{0x0000ff});
    EXPECT_EQ(colours(*scene.bodies[4].seen->mesh), std::vector<int32_t>{0x0000ff});
    EXPECT_EQ(scene.bodies[4].finish, scene::Finish::metal);
    EXPECT_EQ(scene.bodies[0].picture->image->rgb, std::vector<uint8_t>({10, 20, 30, 40, 50, 60}));
    EXPECT_DOUBLE_EQ(scene.bodies[0].picture->width, 0.05);
    EXPECT_EQ(scene.bodies[5].picture->image, scene.bodies[0].picture->image);
}

TEST(FrozenLooks, AreKeptByASessionAndByTheOneThatResumesIt) {
    Sessions sessions;
    const testing::TemporaryFolder& folder = sessions.files.folder;
    write_mesh(folder.file("red"), "1 0 0");
    write_mesh(folder.file("blue"), "0 0 1");
    write_png(Image{2, 1, {10, 20, 30, 40, 50, 60}}, folder.file("wood.png"));
    sessions.files.scene = R"(bodies:
  - { name: table, shape: box, size_mm: [600, 400, 50], position_mm: [0, 0, -25], fixed: yes,
      picture: { file: wood.png, width_mm: 50 } }
  - { name: block, shape: box, size_mm: [40, 40, 40], mass_g: 100, position_mm: [0, 0, 20] }
  - { name: r, shape: mesh, file: red/a.obj, unit: mm, position_mm: [100, 0, 0], fixed: yes }
  - { name: b, shape: mesh, file: blue/a.obj, unit: mm, position_mm: [150, 0, 0], fixed: yes }
  - { name: s, shape: sphere, radius_mm: 10, position_mm: [200, 0, 10], fixed: yes, finish: metal,
      seen: { file: blue/a.obj, unit: mm } }
  - { name: p, shape: sphere, radius_mm: 10, position_mm: [-100, 0, 10], fixed: yes,
      picture: { file: wood.png, width_mm: 20 } }
fingers:
  - { name: index, shape: sphere, radius_mm: 6, mass_g: 1 }
)";
    const std::string cut = sessions.make(Mover::script, true);
    EXPECT_EQ(kept(cut), std::vector<std::string>({"mesh-1-a.mtl", "mesh-1-a.obj", "mesh-2-a.mtl",
                                                   "mesh-2-a.obj", "picture-1-wood.png",
                                                   "seen-1-a.mtl", "seen-1-a.obj"}));
    for (const char* name : {"red", "blue", "wood.png", "scene.yaml"})
        fs::remove_all(folder.file(name));
    expect_looks(cut);
    const RunResult rest = sessions.files.run(rest_of(cut, Seat::terminal, {}).plan);
    EXPECT_EQ(kept(rest.folder).size(), 7u);
    fs::remove_all(cut);
    expect_looks(rest.folder);
}

}  // namespace
}  // namespace dihaptic::session::frozen_looks_test
