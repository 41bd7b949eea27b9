// Tests the reading of meshes by a separate program, which may crash on a damaged file.
#include <sys/stat.h>

#include <thread>

#include "scene/test/mutated_mesh.h"

namespace dihaptic::scene::mesh_test {
namespace {

namespace fs = std::filesystem;

std::string refusal(const std::string& file, const std::stop_token& stop = {}) {
    try {
        read_mesh(file, 1e-3, {"scene.yaml", 7}, stop);
    } catch (const Error& e) {
        EXPECT_FALSE(e.problems().front().remedy.empty());
        return e.what();
    }
    return "none";
}

void expect_refused(const std::string& file, const std::string& why) {
    const std::string said = refusal(file);
    EXPECT_NE(said.find("scene.yaml:7: error: file:"), std::string::npos) << said;
    EXPECT_NE(said.find(file), std::string::npos) << said;
    EXPECT_NE(said.find(why), std::string::npos) << said;
}

/// The corners of the triangles of a mesh, in order and in the unit of its file.
std::vector<Vec3> corners(const Mesh& mesh) {
    std::vector<Vec3> out;
    for (const auto& f : mesh.faces) {
        for (const int i : f) out.push_back(mesh.vertices[static_cast<size_t>(i)]);
    }
    return out;
}

TEST(MeshReading, GivesTheSameTrianglesInEachFormat) {
    const testing::TemporaryFolder folder;
    const std::vector<Vec3> wanted = corners(read_mesh("meshes/stone.obj", 1, {}));
    ASSERT_GT(wanted.size(), 3u * 30);
    const Mesh stone = read_mesh("meshes/stone.obj", 1, {});
    const std::vector<MeshFile> files{{".obj", obj_of(stone)},
                                      {".OFF", off_text(stone)},
                                      {".stl", stl_of(stone, false)},
                                      {".STL", stl_of(stone, true)},
                                      {".ply", ply_of(stone, "ascii")},
                                      {".ply", ply_of(stone, "binary_little_endian")},
                                      {".ply", ply_of(stone, "binary_big_endian")}};
    for (const MeshFile& file : files) {
        const std::string path = folder.write("stone" + file.ending, file.bytes);
        EXPECT_EQ(corners(read_mesh(path, 1, {})), wanted) << file.ending;
    }
}

TEST(MeshReading, CoordinatesAreTheFilesToTheBit) {
    const testing::TemporaryFolder folder;
    // coordinates are rounded to single precision, as in exported meshes, and then scaled in double
    // precision
    const std::string file =
        folder.write("t.obj",
                     "v 0.1 0 0\nv 1 0 0\nv 0 1.7 0\nv 0 0 12345.678\nf 1 3 2\nf 1 2 4\nf 1 4 3\n"
                     "f 2 3 4\n");
    const Mesh mesh = read_mesh(file, 1e-3, {});
    ASSERT_EQ(mesh.vertices.size(), 4u);
    double least = 1;
    double most = 0;
    for (const Vec3& v : mesh.vertices) {
        if (v.x() > 0) least = std::min(least, v.x());
        most = std::max(most, v.z());
    }
    EXPECT_EQ(least, 1e-3 * static_cast<double>(0.1F));
    EXPECT_EQ(most, 1e-3 * static_cast<double>(12345.678F));
}

TEST(MeshReading, GivesTheSameTrianglesWhateverTheMaterials) {
    const testing::TemporaryFolder folder;
    const std::string text =
        "mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nusemtl b\nf 1 3 2\nf 1 2 4\nusemtl a\n"
        "f 1 4 3\nf 2 3 4\n";
    const std::string file = folder.write("m.obj", text);
    const std::vector<Vec3> alone = corners(read_mesh(file, 1, {}));
    ASSERT_EQ(mkfifo(folder.file("m.mtl").c_str(), 0600), 0);  // opening the pipe would block
    EXPECT_EQ(corners(read_mesh(file, 1, {})), alone);
    fs::remove(folder.file("m.mtl"));
    folder.write("m.mtl", "newmtl a\nnewmtl b\n");
    EXPECT_EQ(corners(read_mesh(file, 1, {})), alone);
}

TEST(MeshReading, RefusesWhatIsNoFileWithoutWaiting) {
    const testing::TemporaryFolder folder;
    ASSERT_EQ(mkfifo(folder.file("fifo.obj").c_str(), 0600), 0);
    fs::create_directory(folder.file("folder.obj"));
    fs::create_symlink("/dev/zero", folder.file("zero.obj"));
    fs::create_symlink("loop.obj", folder.file("loop.obj"));
    expect_refused(folder.file("fifo.obj"), "is not a file, but a pipe, a socket or a device");
    expect_refused(folder.file("zero.obj"), "is not a file, but a pipe, a socket or a device");
    expect_refused(folder.file("folder.obj"), "is a folder");
    expect_refused(folder.file("loop.obj"), "cannot be read: Too many levels");
    expect_refused(folder.file("gone.obj"), "there is no mesh");
    expect_refused(folder.write("scene.txt", "v 0 0 0"), "its name ends neither in .obj");
    folder.write("huge.obj", "");
    fs::resize_file(folder.file("huge.obj"), 500'000'000);
    expect_refused(folder.file("huge.obj"), "is 500 MB large; 400 MB are allowed");
}

TEST(MeshReading, SurvivesTwoHundredDamagedFiles) {
    const Outcomes outcomes = read_damaged(whole_meshes(), 0, 200);
    EXPECT_EQ(outcomes.all(), 200);
    EXPECT_GT(outcomes.read, 0) << outcomes.text();
    EXPECT_GT(outcomes.refused, 0) << outcomes.text();
    EXPECT_GT(outcomes.crashed, 0) << outcomes.text();  // otherwise nothing was tested
    for (const std::string& message : outcomes.untold) ADD_FAILURE() << message;
}

TEST(MeshReading, CanBeCancelled) {
    const testing::TemporaryFolder folder;
    std::string big = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\n";
    for (int i = 0; i < 500'000; ++i) big += "f 1 2 3\n";
    const std::string file = folder.write("big.obj", big);
    std::stop_source stop;
    std::thread user([&] {
        std::this_thread::sleep_for(std::chrono::milliseconds(2));
        stop.request_stop();
    });
    const std::string said = refusal(file, stop.get_token());
    user.join();
    EXPECT_NE(said.find("reading the mesh " + file + " was cancelled"), std::string::npos) << said;
}

}  // namespace
}  // namespace dihaptic::scene::mesh_test
