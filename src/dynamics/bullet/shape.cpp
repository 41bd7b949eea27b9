#include "dynamics/bullet/shape.h"

#include <algorithm>

#include "dynamics/bullet/contact_algorithm.h"

namespace dihaptic::dynamics {
namespace {

/// Hulls, cylinders and cones carry a thin skin, without which Bullet's distance algorithm loses
/// the normal at zero depth. Cylinders and boxes are shrunk by the same amount and their edges are
/// rounded (Bullet's own skin would round a box by a tenth of its half edge); a sphere, a capsule
/// or a cone meets a hull at this distance outside its own surface.
constexpr double kSkin = 5e-5;  // [m]

std::unique_ptr<btCollisionShape> bullet_hull(const scene::Hull& hull) {
    auto out = std::make_unique<btConvexHullShape>();
    for (const Vec3& v : hull.vertices) out->addPoint(to_bullet(v), false);
    out->setMargin(kSkin);
    out->recalcLocalAabb();
    return out;
}

std::unique_ptr<btCollisionShape> bullet_shape(const scene::Shape& shape) {
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
        case ShapeKind::cone: {
            auto out = std::make_unique<btConeShapeZ>(shape.radius, shape.length);
            out->setMargin(kSkin);
            return out;
        }
        case ShapeKind::plane:
            return std::make_unique<btStaticPlaneShape>(btVector3(0, 0, 1), 0);
        case ShapeKind::mesh:
            return bullet_hull(shape.hull);
        case ShapeKind::compound:
            break;  // only the parts of a compound have shapes
    }
    return nullptr;
}

std::unique_ptr<Polyhedron> polyhedron(const scene::Shape& shape) {
    if (shape.kind == scene::ShapeKind::box)
        return std::make_unique<Polyhedron>(Polyhedron::box(shape.size));
    if (shape.kind != scene::ShapeKind::mesh) return nullptr;
    auto out = std::make_unique<Polyhedron>(Polyhedron::of(shape.hull));
    const bool small =
        out->edges.size() <= kMostEdges &&
        std::all_of(out->faces.begin(), out->faces.end(), [](const Polyhedron::Face& face) {
            return face.vertices.size() <= Polyhedron::kMostFaceVertices;
        });
    return small ? std::move(out) : nullptr;
}

std::optional<Round> round(const scene::Shape& shape) {
    using scene::ShapeKind;
    switch (shape.kind) {
        case ShapeKind::sphere:
            return Round{shape.radius};
        case ShapeKind::capsule:
            return Round{shape.radius, shape.length / 2};
        case ShapeKind::cylinder:
            return Round{shape.radius, shape.length / 2, Round::Ends::flat};
        case ShapeKind::cone:
            return Round{shape.radius, shape.length / 2, Round::Ends::tip};
        default:
            return std::nullopt;
    }
}

double thickness_of(const btCollisionShape& shape, const Polyhedron* polyhedron) {
    double least = BT_LARGE_FLOAT;
    if (polyhedron == nullptr) {
        btVector3 low;
        btVector3 high;
        shape.getAabb(btTransform::getIdentity(), low, high);
        const btVector3 extent = high - low;
        return extent[extent.minAxis()];
    }
    for (const Polyhedron::Face& face : polyhedron->faces) {
        double low = face.offset;
        for (const Vec3& v : polyhedron->vertices) low = std::min(low, face.normal.dot(v));
        least = std::min(least, face.offset - low);
    }
    return least;
}

/// Outward normals of those faces of part `of` that are covered by other parts.
std::vector<Vec3> covered_faces(const std::vector<scene::ConvexPart>& parts, size_t of,
                                const Polyhedron& polyhedron) {
    constexpr double kOutward = 1e-6;  // [m]
    constexpr double kInward = 0.01;   // as a fraction of the way towards the middle of the face
    std::vector<Vec3> out;
    const auto is_covered = [&](const Vec3& p_S) {
        const Vec3 p_B = parts[of].X_BS * p_S;
        for (size_t i = 0; i < parts.size(); ++i) {
            if (i == of) continue;
            if (scene::depth(parts[i].shape, parts[i].X_BS.inverse() * p_B) > -kOutward)
                return true;
        }
        return false;
    };
    for (const Polyhedron::Face& face : polyhedron.faces) {
        Vec3 middle = Vec3::Zero();
        for (const int v : face.vertices)
            middle += polyhedron.vertices[static_cast<size_t>(v)] /
                      static_cast<double>(face.vertices.size());
        bool covered = is_covered(middle + kOutward * face.normal);
        for (const int v : face.vertices) {
            const Vec3& corner = polyhedron.vertices[static_cast<size_t>(v)];
            covered = covered &&
                      is_covered(corner + kInward * (middle - corner) + kOutward * face.normal);
        }
        if (covered) out.push_back(face.normal);
    }
    return out;
}

}  // namespace

std::vector<std::unique_ptr<CollisionPart>> collision_parts(const scene::Shape& shape,
                                                            const Pose& X_BM) {
    std::vector<std::unique_ptr<CollisionPart>> out;
    const Pose X_MB = X_BM.inverse();
    std::vector<scene::ConvexPart> parts = scene::convex_parts(shape);
    for (scene::ConvexPart& convex : parts) {
        // transform hulls once, here, instead of in every step
        if (convex.shape.kind != scene::ShapeKind::mesh) continue;
        const Pose X_MS = X_MB * convex.X_BS;
        for (Vec3& v : convex.shape.hull.vertices) v = X_MS * v;
        convex.X_BS = X_BM;
    }
    for (size_t i = 0; i < parts.size(); ++i) {
        const scene::ConvexPart& convex = parts[i];
        const bool is_mesh = convex.shape.kind == scene::ShapeKind::mesh;
        const Pose X_MS = is_mesh ? Pose{} : X_MB * convex.X_BS;
        auto part = std::make_unique<CollisionPart>();
        part->shape = bullet_shape(convex.shape);
        part->polyhedron = polyhedron(convex.shape);
        if (part->polyhedron)
            part->polyhedron->covered = covered_faces(parts, i, *part->polyhedron);
        part->round = round(convex.shape);
        part->thickness = thickness_of(*part->shape, part->polyhedron.get());
        part->shape->setUserPointer(part.get());
        btScalar radius = 0;
        part->shape->getBoundingSphere(part->centre, radius);
        part->radius = radius;
        part->X_MS = to_bullet(X_MS);
        part->moved = !X_MS.p.isZero(0) || !X_MS.R.vec().isZero(0);
        out.push_back(std::move(part));
    }
    return out;
}

void CollisionPart::place(int64_t search) {
    if (placing == search) return;
    const btTransform now = X_WS();
    const bool first = placing == 0;
    placing = search;
    if (!first && now == placed_at) return;
    const Pose last = X_WS_placed;
    placed_at = now;
    X_WS_placed = from_bullet(now);
    if (first) return;
    const Vec3 middle = from_bullet(centre);
    // a point at the distance r from the axis of a turn by an angle moves by 2 r sin(angle / 2)
    way += (X_WS_placed * middle - last * middle).norm() +
           2 * (X_WS_placed.R * last.R.conjugate()).vec().norm() * radius;
}

void CollisionPart::time(int64_t search) {
    if (timing == search) return;
    timing = search;
    turning = turning_at(X_WS());
}

double CollisionPart::turning_at(const btTransform& X_WS) const {
    const btScalar speed = body->getInterpolationAngularVelocity().length();
    if (speed == 0) return 0;
    const btVector3 off = X_WS * centre - body->getWorldTransform().getOrigin();
    return speed * (off.length() + radius);
}

double approach(const CollisionPart& a, const CollisionPart& b, double h) {
    const btVector3 closing =
        a.body->getInterpolationLinearVelocity() - b.body->getInterpolationLinearVelocity();
    return h * (closing.length() + a.turning + b.turning);
}

}  // namespace dihaptic::dynamics
