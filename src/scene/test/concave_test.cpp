// Tests concave meshes and compounds: their weight, and how their convex pieces are cut and stored.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <thread>

#include "base/number.h"
#include "scene/closed.h"
#include "scene/mesh.h"
#include "scene/scene.h"
#include "testing/files.h"

namespace dihaptic::scene::concave_test {
namespace {

namespace fs = std::filesystem;

/// An L-shaped mesh of two boxes, 2 x 1 x 1 and 1 x 1 x 1. The second is on top of the first along
/// y.
constexpr const char* kL =
    "v 0 0 0\nv 2 0 0\nv 2 1 0\nv 1 1 0\nv 1 2 0\nv 0 2 0\n"
    "v 0 0 1\nv 2 0 1\nv 2 1 1\nv 1 1 1\nv 1 2 1\nv 0 2 1\n"
    "f 4 3 2 1\nf 6 5 4 1\nf 7 8 9 10\nf 7 10 11 12\nf 1 2 8 7\nf 2 3 9 8\nf 3 4 10 9\n"
    "f 4 5 11 10\nf 5 6 12 11\nf 6 1 7 12\n";
constexpr const char* kBody =
    "bodies:\n  - {name: l, shape: mesh, file: l.obj, unit: cm, concave: yes, mass_g: 10}\n";
constexpr const char* kCompound =
    "bodies:\n  - name: l\n    shape: compound\n    mass_g: 10\n    parts:\n"
    "      - {shape: box, size_cm: [2, 1, 1], position_cm: [1, 0.5, 0.5]}\n"
    "      - {shape: box, size_cm: [1, 1, 1], position_cm: [0.5, 1.5, 0.5], rotation_deg: [0, 90, "
    "0]}\n";

struct Files {
    testing::TemporaryFolder folder;
    Diagnostics diagnostics;

    explicit Files(const std::string& mesh) {
        folder.write("l.obj", mesh);
        setenv("XDG_CACHE_HOME", folder.file("cache").c_str(), 1);
    }
    ~Files() { unsetenv("XDG_CACHE_HOME"); }
    Shape read(const std::string& text, const std::stop_token& stop = {}) {
        diagnostics = Diagnostics();
        const Scene scene = read_scene(folder.write("scene.yaml", text), diagnostics, stop);
        return scene.bodies.empty() ? Shape{} : scene.bodies[0].shape;
    }
    std::string said() const {
        std::string out;
        for (const Problem& problem : diagnostics.problems()) out += problem.text() + "\n";
        return out;
    }
    /// The file of pieces that was written most recently; "" if there is none.
    std::string kept() const {
        std::error_code none;
        fs::path out;
        for (const auto& entry : fs::directory_iterator(folder.file("cache/dihaptic/pieces"), none))
            if (out.empty() || entry.last_write_time() > fs::last_write_time(out))
                out = entry.path();
        return out.string();
    }
};

/// Compares with values that were calculated by hand from the two boxes and the parallel axis
/// theorem, in cm.
void expect_l(const VolumeIntegrals& l) {
    constexpr double cm = 1e-2;
    EXPECT_NEAR(l.volume, 3 * std::pow(cm, 3), 1e-14);
    EXPECT_LT((l.centre - cm * Vec3(5.0 / 6, 5.0 / 6, 0.5)).norm(), 1e-10);
    Mat3 inertia;
    inertia << 7.0 / 6, 1.0 / 3, 0, 1.0 / 3, 7.0 / 6, 0, 0, 0, 11.0 / 6;
    EXPECT_LT((l.inertia - std::pow(cm, 5) * inertia).norm(), 1e-17);
}

double volume(const std::vector<Hull>& hulls) {
    double sum = 0;
    for (const Hull& hull : hulls) sum += integrate(hull.vertices, hull.faces).volume;
    return sum;
}

TEST(Concave, AnLWeighsWhatItsTwoBoxesDo) {
    Files files(kL);
    const Shape mesh = files.read(kBody);
    EXPECT_EQ(files.said(), "");
    expect_l(integrate(mesh));
    expect_l(integrate(files.read(kCompound)));
    EXPECT_EQ(files.said(), "");
}

TEST(Concave, ThePiecesFillTheMeshAndNoMore) {
    Files files(kL);
    const Shape shape = files.read(kBody);
    EXPECT_EQ(shape.pieces.hulls.size(), 2u);
    EXPECT_NEAR(volume(shape.pieces.hulls), 3e-6, 1e-12);
    EXPECT_GT(depth(shape, {0.005, 0.015, 0.005}), 0.0049);
    EXPECT_LT(depth(shape, {0.015, 0.015, 0.005}), -0.0049);  // inside the hull, but outside the L
    const Shape boxes = files.read(kCompound);
    EXPECT_NEAR(depth(boxes, {0.005, 0.015, 0.005}), 0.005, 1e-12);
    EXPECT_NEAR(depth(boxes, {0.015, 0.015, 0.005}), -0.005, 1e-12);
    EXPECT_EQ(convex_parts(boxes).size(), 2u);
    EXPECT_NEAR(extent(boxes), 0.02, 1e-12);
}

TEST(Concave, TheShippedMeshesAreFilledByTheirPieces) {
    for (const char* name : {"cup", "hook", "spatula"}) {
        const std::string file = std::string("meshes/") + name + ".obj";
        Diagnostics diagnostics;
        const MeshName said{file, {}, 1e-3, "mm"};
        const ClosedMesh mesh = closed(read_mesh(file, 1e-3, {}), said, diagnostics);
        const Pieces pieces = convex_pieces(mesh, said, diagnostics);
        const double solid = integrate(mesh.mesh.vertices, mesh.mesh.faces).volume;
        EXPECT_NEAR(volume(pieces.hulls) / solid, 1, 1e-6) << name;
        EXPECT_LE(pieces.hulls.size(), 40u) << name;
    }
}

TEST(Concave, PiecesAreKeptAndReadAgain) {
    Files files(kL);
    const Shape first = files.read(kBody);
    const std::string file = files.kept();
    const std::string kept = testing::read_file(file);
    ASSERT_FALSE(kept.empty());
    // that folder may belong to somebody else, so nothing is written there
    EXPECT_FALSE(fs::exists(files.folder.file("l.obj.pieces")));
    const auto written = fs::last_write_time(files.kept());
    const Shape second = files.read(kBody);
    EXPECT_EQ(fs::last_write_time(files.kept()), written);
    ASSERT_EQ(second.pieces.hulls.size(), first.pieces.hulls.size());
    for (size_t i = 0; i < first.pieces.hulls.size(); ++i)
        EXPECT_EQ(first.pieces.hulls[i].vertices, second.pieces.hulls[i].vertices);

    // another mesh, or the same mesh in another unit, has other pieces
    files.read(std::string(kBody).replace(std::string(kBody).find("cm,"), 2, "mm"));
    EXPECT_NE(testing::read_file(files.kept()), kept);
    files.read(kBody);
    EXPECT_EQ(testing::read_file(file), kept);
}

TEST(Concave, PiecesBesideTheMeshAreTaken) {
    Files files(kL);
    files.read(kBody);
    fs::rename(files.kept(), files.folder.file("l.obj.pieces"));
    files.read(kBody);
    EXPECT_EQ(files.kept(), "");
}

/// Converts a file of pieces to the form in which version 0.2 wrote it.
std::string of_first_version(std::string kept) {
    kept = kept.substr(0, kept.rfind("end ")).replace(kept.find(" 2\n"), 3, " 1\n");
    uint64_t print = 0xcbf29ce484222325U;  // FNV-1a
    for (const char c : kept) print = (print ^ static_cast<unsigned char>(c)) * 0x100000001b3U;
    return kept + fmt::format("end {:016x}\n", print);
}

TEST(Concave, PiecesOfTheFirstVersionAreTakenIfTheyFillTheMesh) {
    Files files(kL);
    files.read(kBody);
    const std::string file = files.kept();
    const std::string kept = testing::read_file(file);
    const std::string good = of_first_version(kept);
    std::ofstream(file, std::ios::binary) << good;
    EXPECT_NEAR(volume(files.read(kBody).pieces.hulls), 3e-6, 1e-12);
    EXPECT_EQ(testing::read_file(file), good);
    // keeps only one of the two pieces, as happens through faults in the library
    std::string lost = kept;
    lost.erase(lost.rfind("piece "), lost.rfind("end ") - lost.rfind("piece "));
    std::ofstream(file, std::ios::binary) << of_first_version(lost);
    EXPECT_NEAR(volume(files.read(kBody).pieces.hulls), 3e-6, 1e-12);
    EXPECT_EQ(testing::read_file(file), kept);
}

/// A prism with a star-shaped base. The time needed to cut it grows with the number of points of
/// the star.
std::string star(int teeth) {
    std::string out;
    const int n = 2 * teeth;
    for (const int z : {0, 1}) {
        for (int i = 0; i < n; ++i) {
            const double r = i % 2 == 0 ? 1 : 2;
            const double angle = std::numbers::pi * i / teeth;
            out += "v " + number_text(r * std::cos(angle)) + " " +
                   number_text(r * std::sin(angle)) + " " + number_text(z) + "\n";
        }
    }
    std::string top = "f";
    std::string bottom = "f";
    for (int i = 0; i < n; ++i) {
        bottom += " " + number_text(n - i);
        top += " " + number_text(n + i + 1);
        const int next = (i + 1) % n;
        out += "f " + number_text(i + 1) + " " + number_text(next + 1) + " " +
               number_text(n + next + 1) + " " + number_text(n + i + 1) + "\n";
    }
    return out + top + "\n" + bottom + "\n";
}

TEST(Concave, ACutThatTakesLongCanBeCancelled) {
    Files files(star(300));
    std::stop_source stop;
    std::thread user([&] {
        std::this_thread::sleep_for(std::chrono::milliseconds(500));  // by then, the cut has begun
        stop.request_stop();
    });
    const auto begin = std::chrono::steady_clock::now();
    files.read(kBody, stop.get_token());
    user.join();
    EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(10));
    EXPECT_NE(files.said().find("was cancelled"), std::string::npos) << files.said();
    EXPECT_FALSE(fs::exists(files.kept()));
}

TEST(Concave, DamagedPiecesAreCutAnew) {
    Files files(kL);
    files.read(kBody);
    const std::string file = files.kept();
    const std::string kept = testing::read_file(file);
    std::string changed = kept;
    changed[kept.find("0.01", kept.find("piece "))] = '7';
    for (const std::string& damage :
         {std::string(), std::string("nonsense"), kept.substr(0, kept.size() / 2), changed}) {
        std::ofstream(file, std::ios::binary) << damage;
        EXPECT_NEAR(volume(files.read(kBody).pieces.hulls), 3e-6, 1e-12);
        EXPECT_EQ(files.said(), "");
        EXPECT_EQ(testing::read_file(file), kept);
    }
}

TEST(Concave, WorksWherePiecesCannotBeKeptAndSaysSo) {
    Files files(kL);
    fs::create_directories(files.folder.file("cache"));
    std::ofstream(files.folder.file("cache/dihaptic")) << "a file, where a folder has to be";
    EXPECT_NEAR(volume(files.read(kBody).pieces.hulls), 3e-6, 1e-12);
    EXPECT_FALSE(files.diagnostics.has_errors());
    EXPECT_NE(files.said().find("cannot be kept"), std::string::npos) << files.said();
    EXPECT_NE(files.said().find("cut again in each run"), std::string::npos);
    EXPECT_TRUE(fs::is_regular_file(files.folder.file("cache/dihaptic")));
}

TEST(Concave, AMeshWithAHoleIsRefused) {
    Files files(std::string(kL).substr(0, std::string(kL).rfind("f ")));
    files.read(kBody);
    EXPECT_TRUE(files.diagnostics.has_errors());
    EXPECT_NE(files.said().find("is not closed: 4 of its edges"), std::string::npos)
        << files.said();
    EXPECT_NE(files.said().find("scene.yaml:2"), std::string::npos) << files.said();
}

TEST(Concave, AMeshTurnedInsideOutIsTurnedBack) {
    Mesh mesh;
    mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    mesh.faces = {{0, 1, 2}, {0, 3, 1}, {0, 2, 3}, {1, 3, 2}};
    Diagnostics diagnostics;
    const Mesh out = closed(mesh, {}, diagnostics).mesh;
    EXPECT_TRUE(diagnostics.problems().empty());
    EXPECT_NEAR(integrate(out.vertices, out.faces).volume, 1.0 / 6, 1e-12);
}

TEST(Compound, PartsThatCannotBeAreRefused) {
    Files files(kL);
    files.read("bodies:\n  - {name: a, shape: compound, mass_g: 1}\n");
    EXPECT_NE(files.said().find("parts: is missing"), std::string::npos) << files.said();
    files.read("bodies:\n  - {name: a, shape: compound, mass_g: 1, parts: []}\n");
    EXPECT_NE(files.said().find("parts: there are none"), std::string::npos) << files.said();
    files.read("bodies:\n  - {name: a, shape: compound, fixed: yes, parts: [{shape: plane}]}\n");
    EXPECT_NE(files.said().find("a part cannot be a plane"), std::string::npos) << files.said();
}

}  // namespace
}  // namespace dihaptic::scene::concave_test
