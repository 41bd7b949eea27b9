#include "dynamics/bullet/shape.h"

#include <algorithm>

#include "dynamics/bullet/polyhedron_algorithm.h"

namespace dihaptic::dynamics {
namespace {

/// Hulls and cylinders carry a thin skin, without which Bullet's distance algorithm loses its
/// normal at depth zero. Cylinders and boxes are drawn in by as much, and their edges rounded
/// (Bullet's own skin would round a box by a tenth of its half edge); a sphere or a capsule meets a
/// hull this far outside its surface.
constexpr double kSkin = 5e-5;  // [m]

std::unique_ptr<btCollisionShape> bullet_hull(const scene::Hull& hull, const Pose& X_BM) {
    const Pose X_MB = X_BM.inverse();
    auto out = std::make_unique<btConvexHullShape>();
    for (const Vec3& v : hull.vertices) out->addPoint(to_bullet(X_MB * v), false);
    out->setMargin(kSkin);
    out->recalcLocalAabb();
    return out;
}

}  // namespace

std::unique_ptr<btCollisionShape> bullet_shape(const scene::Shape& shape, const Pose& X_BM) {
    using scene::ShapeKind;
    switch (shape.kind) {
        case ShapeKind::box: {
            auto out = std::make_unique<btBoxShape>(to_bullet(Vec3(shape.size / 2)));
            out->setMargin(kSkin);
            return out;
        }
        case ShapeKind::sphere:
            return std::make_unique<btSphereShape>(shape.radius);
        case ShapeKind::capsule:
            return std::make_unique<btCapsuleShapeZ>(shape.radius, shape.length);
        case ShapeKind::cylinder: {
            auto out = std::make_unique<btCylinderShapeZ>(
                btVector3(shape.radius, shape.radius, shape.length / 2));
            out->setMargin(kSkin);
            return out;
        }
        case ShapeKind::plane:
            return std::make_unique<btStaticPlaneShape>(btVector3(0, 0, 1), 0);
        case ShapeKind::mesh:
            return bullet_hull(shape.hull, X_BM);
    }
    return nullptr;
}

std::unique_ptr<Polyhedron> polyhedron(const scene::Shape& shape, const Pose& X_BM) {
    if (shape.kind == scene::ShapeKind::box)
        return std::make_unique<Polyhedron>(Polyhedron::box(shape.size));
    if (shape.kind != scene::ShapeKind::mesh) return nullptr;
    scene::Hull hull = shape.hull;
    for (Vec3& v : hull.vertices) v = X_BM.inverse() * v;
    auto out = std::make_unique<Polyhedron>(Polyhedron::of(hull));
    const bool small =
        out->edges.size() <= kMostEdges &&
        std::all_of(out->faces.begin(), out->faces.end(), [](const Polyhedron::Face& face) {
            return face.vertices.size() <= Polyhedron::kMostFaceVertices;
        });
    return small ? std::move(out) : nullptr;
}

}  // namespace dihaptic::dynamics
