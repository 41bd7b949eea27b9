// Tests that meshes get the colours in their files.
#include <sys/stat.h>

#include "scene/test/coloured_mesh.h"
#include "scene/test/mutated_mesh.h"

namespace dihaptic::scene::mesh_colours_test {
namespace {

/// The colour of a mesh at each corner of each of its faces.
std::vector<int32_t> corner_colours(const Mesh& mesh) {
    std::vector<int32_t> out;
    for (const auto& face : mesh.faces) {
        for (const int v : face) out.push_back(mesh.colours.at(static_cast<size_t>(v)));
    }
    return out;
}

TEST(MeshColours, AreThoseOfTheFile) {
    const testing::TemporaryFolder folder;
    const std::string obj =
        "v 0 0 0 1 0 0\nv 20 0 0 0 1 0\nv 0 20 0 0 0 1\nv 0 0 20 0.0706 0.2039 0.3373\nf 1 3 2\n"
        "f 1 2 4\nf 1 4 3\nf 2 3 4\n";
    constexpr int32_t r = 0xff0000, g = 0x00ff00, b = 0x0000ff, k = 0x123456;
    const std::vector<int32_t> wanted{r, b, g, r, g, k, r, k, b, g, b, k};
    for (const auto& [name, text] :
         {std::pair<const char*, std::string>{"a.ply", tetrahedron_ply()},
          {"a.off", tetrahedron_off(true)},
          {"b.off", tetrahedron_off(false)},
          {"a.obj", obj}}) {
        const Mesh mesh = read_mesh(folder.write(name, text), 1e-3, {});
        EXPECT_EQ(corner_colours(mesh), wanted) << name;
    }
    EXPECT_TRUE(read_mesh("meshes/stone.obj", 1, {}).colours.empty());
    // the colours of the vertices are used, because a missing materials file gives none
    const Mesh both = read_mesh(folder.write("b.obj", "mtllib gone.mtl\n" + obj), 1e-3, {});
    EXPECT_EQ(corner_colours(both), wanted);
    EXPECT_EQ(both.materials, "");
}

TEST(MeshColours, OfStlAreNone) {
    const testing::TemporaryFolder folder;
    std::string bytes = stl_of(read_mesh("meshes/stone.obj", 1, {}), true);
    // fills the spare bytes, which some programs read as colours
    for (size_t at = 84 + 48; at + 1 < bytes.size(); at += 50) bytes.replace(at, 2, "\xff\xff");
    EXPECT_TRUE(read_mesh(folder.write("s.stl", bytes), 1, {}).colours.empty());
}

TEST(MeshColours, OfMaterialsAreInTheFileThatTheMeshNames) {
    const testing::TemporaryFolder folder;
    folder.write("parts.mtl", kMaterials);
    const std::vector<int32_t> wanted{0x663333, 0x663333, 0x663333, 0x0033ff, 0x0033ff, 0x0033ff,
                                      0x0033ff, 0x0033ff, 0x0033ff, 0x0033ff, 0x0033ff, 0x0033ff};
    for (const char* library :
         {"mtllib parts.mtl\n", "# mtllib no.mtl\nmtllib  parts.mtl \r\n",
          "mtllib C:\\models\\parts.mtl\n", "mtllib /home/someone/parts.mtl\n"}) {
        const std::string file = folder.write("a.obj", tetrahedron_obj(library));
        const Mesh mesh = read_mesh(file, 1e-3, {});
        EXPECT_EQ(corner_colours(mesh), wanted) << library;
        EXPECT_EQ(mesh.materials, folder.file("parts.mtl")) << library;
    }
    // the mesh in the form in which a session keeps it
    const std::string copy = folder.write("mesh-1-a.obj", tetrahedron_obj("mtllib gone.mtl\n"));
    folder.write("mesh-1-a.mtl", kMaterials);
    EXPECT_EQ(corner_colours(read_mesh(copy, 1e-3, {})), wanted);
}

TEST(MeshColours, OfWhichThereAreNoneLeaveTheMeshAsItIs) {
    const testing::TemporaryFolder folder;
    const auto colours = [&](const std::string& library) {
        return read_mesh(folder.write("a.obj", tetrahedron_obj(library)), 1e-3, {}).colours;
    };
    folder.write("bare.mtl", "newmtl steel\nnewmtl old oak\nKd\nKd red\n");
    folder.write("noise.mtl", std::string("\0\xff Kd 1 1 1\n\n\nKd 1 1", 21));
    ASSERT_EQ(mkfifo(folder.file("pipe.mtl").c_str(), 0600), 0);  // opening the pipe would block
    for (const char* library : {"", "mtllib\n", "mtllib \n", "mtllib /\n", "mtllib no.mtl\n",
                                "mtllib bare.mtl\n", "mtllib noise.mtl\n", "mtllib pipe.mtl\n"})
        EXPECT_TRUE(colours(library).empty()) << library;
    // the materials file contains only one of the two materials
    folder.write("half.mtl", "newmtl steel\nKd 1 1 1\n");
    const std::vector<int32_t> half = colours("mtllib half.mtl\n");
    EXPECT_EQ(std::count(half.begin(), half.end(), -1), 3);
    EXPECT_EQ(std::count(half.begin(), half.end(), 0xffffff), 4);
}

}  // namespace
}  // namespace dihaptic::scene::mesh_colours_test
