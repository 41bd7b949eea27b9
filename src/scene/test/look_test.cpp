// Tests how bodies look: pictures, meshes that are seen but not felt, and the colours of meshes.
#include "scene/look.h"

#include <gtest/gtest.h>

#include "base/image.h"
#include "scene/test/coloured_mesh.h"
#include "scene/test/read_text.h"
#include "testing/files.h"

namespace dihaptic::scene::look_test {
namespace {

constexpr const char* kBox = "shape: box\n    size_mm: [20, 20, 20]\n    mass_g: 1\n    ";

/// A scene with one body that looks as `keys` describe.
std::string body(const std::string& keys, const std::string& shape = kBox) {
    return "bodies:\n  - name: b\n    " + shape + keys + "\n";
}

std::string problems(const std::string& yaml) {
    Diagnostics diagnostics;
    read_text(yaml, diagnostics);
    std::string out;
    for (const Problem& problem : diagnostics.problems()) {
        EXPECT_FALSE(problem.remedy.empty());
        out += problem.text() + "\n";
    }
    return out;
}

std::string png(const testing::TemporaryFolder& folder, const std::string& name, int width,
                int height) {
    const size_t bytes = 3 * static_cast<size_t>(width) * static_cast<size_t>(height);
    write_png(Image{width, height, std::vector<uint8_t>(bytes, 100)}, folder.file(name));
    return folder.file(name);
}

/// However the mesh is drawn, the felt shape is bitwise the same.
TEST(Look, OfAMeshChangesNothingThatIsFelt) {
    const testing::TemporaryFolder folder;
    folder.write("m.mtl", kMaterials);
    const std::string file = folder.write("a.obj", tetrahedron_obj("mtllib m.mtl\n"));
    for (const char* concave : {"no", "yes"}) {
        const std::string mesh = fmt::format(
            "shape: mesh\n    file: {}\n    unit: mm\n    concave: {}\n    mass_g: 1\n    ", file,
            concave);
        Diagnostics diagnostics;
        const Shape own = read_text(body("finish: matt", mesh), diagnostics).bodies[0].shape;
        const Shape given =
            read_text(body("colour: \"#ffffff\"", mesh), diagnostics).bodies[0].shape;
        EXPECT_TRUE(diagnostics.problems().empty());
        ASSERT_TRUE(own.coloured);
        EXPECT_FALSE(given.coloured);
        EXPECT_EQ(own.hull.vertices, given.hull.vertices);
        EXPECT_EQ(own.hull.faces, given.hull.faces);
        EXPECT_EQ(own.surface.vertices, given.surface.vertices);
        EXPECT_EQ(own.pieces.hulls.size(), given.pieces.hulls.size());
        EXPECT_EQ(integrate(own).inertia, integrate(given).inertia);
    }
}

TEST(Look, OfAFileIsRead) {
    const testing::TemporaryFolder folder;
    const std::string picture = png(folder, "p.png", 30, 20);
    const std::string mesh = folder.write("a.ply", tetrahedron_ply());
    Diagnostics diagnostics;
    const Scene scene =
        read_text(body("finish: metal\n    picture: { file: " + picture +
                       ", width_mm: 60 }\n    seen: { file: " + mesh + ", unit: mm }"),
                  diagnostics);
    EXPECT_TRUE(diagnostics.problems().empty());
    const Body& b = scene.bodies.front();
    EXPECT_EQ(b.finish, Finish::metal);
    EXPECT_DOUBLE_EQ(b.picture->width, 0.06);
    EXPECT_EQ(b.picture->image->height, 20);
    EXPECT_EQ(b.seen->mesh->vertices.size(), 4u);
    EXPECT_TRUE(b.seen->mesh->colours.empty());  // the picture replaces the colours
    // the shape that is felt is the box
    EXPECT_DOUBLE_EQ(integrate(b.shape).volume, 8e-6);
}

TEST(Look, AMeshThatIsSeenHasItsColoursUnlessTheBodyHasOne) {
    const testing::TemporaryFolder folder;
    const std::string seen =
        "seen: { file: " + folder.write("a.ply", tetrahedron_ply()) + ", unit: mm }";
    Diagnostics diagnostics;
    EXPECT_EQ(read_text(body(seen), diagnostics).bodies[0].seen->mesh->colours.size(), 4u);
    const std::string white = seen + "\n    colour: \"#ffffff\"";
    EXPECT_TRUE(read_text(body(white), diagnostics).bodies[0].seen->mesh->colours.empty());
    EXPECT_TRUE(diagnostics.problems().empty());
}

TEST(Look, APictureIsReadOnceForAllBodiesThatWearIt) {
    const testing::TemporaryFolder folder;
    const std::string keys =
        "    picture: { file: " + png(folder, "p.png", 8, 8) + ", width_mm: 60 }\n";
    Diagnostics diagnostics;
    const Scene scene = read_text("bodies:\n  - name: a\n    " + std::string(kBox) + "\n" + keys +
                                      "  - name: b\n    " + kBox + "\n" + keys,
                                  diagnostics);
    EXPECT_TRUE(diagnostics.problems().empty());
    EXPECT_EQ(scene.bodies[0].picture->image, scene.bodies[1].picture->image);
}

TEST(Look, ThatCannotBeIsToldWithItsPlaceAndARemedy) {
    const testing::TemporaryFolder folder;
    const std::string good = png(folder, "good.png", 8, 8);
    const std::string wide = png(folder, "wide.png", 4097, 1);
    const std::string mesh = folder.write("a.ply", tetrahedron_ply());
    const std::string points = folder.write("p.obj", "v 0 0 0\nv 1 0 0\n");
    const auto picture = [](const std::string& of) { return "picture: { " + of + " }"; };
    const auto seen = [](const std::string& of) { return "seen: { " + of + " }"; };
    for (const auto& [keys, said] : {
             std::pair<std::string, std::string>{
                 picture("file: nowhere.png, width_mm: 10"),
                 "scene.yaml:6: error: file: the picture nowhere.png: "},
             {picture("file: README.md, width_mm: 10"), "the picture README.md: cannot be read"},
             {picture("file: " + wide + ", width_mm: 10"), "has 4097 x 1 pixels"},
             {picture("file: " + good + ", width_mm: 0"), "scene.yaml:6: error: width_mm: "},
             {picture("file: " + good), "width: is missing"},
             {picture("width_mm: 10"), "file: is missing"},
             {picture("file: " + good + ", width_mm: 10") + "\n    colour: \"#ffffff\"",
              "scene.yaml:6: error: picture: cannot be combined with a colour"},
             {seen("file: nowhere.obj, unit: mm"),
              "scene.yaml:6: error: file: there is no mesh nowhere.obj"},
             {seen("file: " + points + ", unit: mm"), "has 2 vertices ('v') and no faces ('f')"},
             {seen("file: README.md, unit: mm"), "its name ends neither in .obj"},
             {seen("file: " + mesh), "unit: is missing"},
             {seen("file: " + mesh + ", unit: m"),
              "a.ply measures 20000 mm, but the felt shape measures 20 mm"},
             {"finish: glossy", "'glossy' is not known. Use satin, matt or metal."},
         }) {
        EXPECT_NE(problems(body(keys)).find(said), std::string::npos) << keys << ":\n"
                                                                      << problems(body(keys));
    }
}

TEST(Look, AMeshWhoseMaterialsAreMissingIsDrawnAndTold) {
    const testing::TemporaryFolder folder;
    const std::string file = folder.write("a.obj", tetrahedron_obj("mtllib gone.mtl\n"));
    const std::string mesh =
        "shape: mesh\n    file: " + file + "\n    unit: mm\n    mass_g: 1\n    ";
    const std::string said = problems(body("finish: matt", mesh));
    EXPECT_NE(
        said.find("scene.yaml:4: warning: file: the mesh " + file + " takes its colours from " +
                  folder.file("gone.mtl") + ", which does not exist"),
        std::string::npos)
        << said;
    EXPECT_EQ(problems(body("colour: \"#ffffff\"", mesh)), "");
    folder.write("gone.mtl", "newmtl a\n");
    EXPECT_NE(problems(body("finish: matt", mesh)).find("has no colour (Kd) for its materials"),
              std::string::npos);
}

}  // namespace
}  // namespace dihaptic::scene::look_test
