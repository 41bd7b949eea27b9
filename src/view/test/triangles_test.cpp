#include "view/triangles.h"

#include <gtest/gtest.h>

#include "scene/scene.h"

namespace dihaptic::view::triangles_test {
namespace {

scene::VolumeIntegrals solid(const Triangles& t) {
    std::vector<Vec3> vertices;
    for (const Vertex& v : t.vertices) vertices.push_back(v.p.cast<double>());
    std::vector<std::vector<int>> faces;
    for (size_t i = 0; i < t.indices.size(); i += 3)
        faces.push_back({static_cast<int>(t.indices[i]), static_cast<int>(t.indices[i + 1]),
                         static_cast<int>(t.indices[i + 2])});
    return scene::integrate(vertices, faces);
}

/// Ratio of the volume enclosed by the triangles to that of the shape; negative if the triangles
/// face inward.
double share(const scene::Shape& shape) {
    return solid(triangles(shape)).volume / scene::integrate(shape).volume;
}

scene::Shape lying(scene::ShapeKind kind) {
    scene::Shape shape;
    shape.kind = kind;
    shape.radius = 0.02;
    shape.length = 0.06;
    return shape;
}

void expect_normals_outward(const Triangles& t) {
    for (size_t i = 0; i < t.indices.size(); i += 3) {
        const Vertex& a = t.vertices[t.indices[i]];
        const Vertex& b = t.vertices[t.indices[i + 1]];
        const Vertex& c = t.vertices[t.indices[i + 2]];
        const Eigen::Vector3f face = (b.p - a.p).cross(c.p - a.p);
        if (face.norm() < 1e-9F) continue;  // degenerate triangles at the poles
        for (const Vertex* v : {&a, &b, &c}) {
            EXPECT_NEAR(v->n.norm(), 1, 1e-5);
            EXPECT_GT(v->n.dot(face.normalized()), 0.6F);
        }
    }
}

TEST(Triangles, EncloseNearlyTheVolumeOfEachShapeAndNoneOutside) {
    for (const scene::Shape& shape :
         {scene::Shape::box({0.04, 0.06, 0.08}), scene::Shape::sphere(0.03),
          lying(scene::ShapeKind::capsule), lying(scene::ShapeKind::cylinder),
          lying(scene::ShapeKind::cone)}) {
        EXPECT_GT(share(shape), 0.985) << static_cast<int>(shape.kind);
        EXPECT_LT(share(shape), 1) << static_cast<int>(shape.kind);
        const Triangles all = triangles(shape);
        expect_normals_outward(all);
        for (const Vertex& v : all.vertices)
            EXPECT_GT(scene::depth(shape, v.p.cast<double>()), -1e-7);
    }
}

TEST(Triangles, AConcaveMeshIsDrawnItselfNotItsHull) {
    Diagnostics diagnostics;
    const scene::Scene scene = scene::read_scene("scenes/tools.yaml", diagnostics);
    const scene::Shape& cup = scene.bodies[static_cast<size_t>(scene.find("cup"))].shape;
    EXPECT_NEAR(share(cup), 1, 1e-5);
    EXPECT_LT(share(cup), 0.7 * scene::integrate(cup.hull.vertices, cup.hull.faces).volume /
                              scene::integrate(cup).volume);
    const scene::Shape& mug = scene.bodies[static_cast<size_t>(scene.find("mug"))].shape;
    EXPECT_NEAR(share(mug), 1, 0.02);  // its handle consists of rounded boxes
}

TEST(Triangles, AConvexMeshIsDrawnAsItIsFelt) {
    Diagnostics diagnostics;
    const scene::Scene scene = scene::read_scene("scenes/tools.yaml", diagnostics);
    const scene::Shape& fingertip = scene.fingers.front().shape;
    EXPECT_NEAR(share(fingertip), 1, 1e-5);
    expect_normals_outward(triangles(fingertip));
}

TEST(Triangles, ATubeFollowsItsPathThroughTurnsAndBack) {
    const std::vector<Vec3> path{{0, 0, 0}, {0.1, 0, 0}, {0.1, 0.1, 0}, {0.1, 0, 0}};
    const Triangles all = tube(path, 0.001);
    ASSERT_FALSE(all.indices.empty());
    for (const Vertex& v : all.vertices) {
        ASSERT_TRUE(v.p.allFinite() && v.n.allFinite());
        const double x = v.p.x();
        const double y = v.p.y();
        EXPECT_LT(std::min(std::hypot(y, v.p.z()), std::hypot(x - 0.1, v.p.z())), 0.0011);
    }
    EXPECT_TRUE(tube({}, 0.001).indices.empty());
    const std::vector<Vec3> still{{1, 1, 1}, {1, 1, 1}};
    EXPECT_TRUE(tube(still, 0.001).indices.empty());
}

}  // namespace
}  // namespace dihaptic::view::triangles_test
