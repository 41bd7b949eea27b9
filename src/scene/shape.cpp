#include "scene/shape.h"

#include <cmath>
#include <limits>
#include <numbers>

namespace dihaptic::scene {
namespace {

constexpr double kPi = std::numbers::pi;

VolumeIntegrals symmetric(double volume, const Vec3& inertia) {
    VolumeIntegrals out;
    out.volume = volume;
    out.inertia = inertia.asDiagonal();
    return out;
}

VolumeIntegrals moved(const VolumeIntegrals& in, const Pose& X) {
    const Mat3 R = X.R.toRotationMatrix();
    return {in.volume, X * in.centre, R * in.inertia * R.transpose()};
}

/// Sum of the integrals over parts, with the moments of each part moved to the common centre
/// (parallel axis theorem).
VolumeIntegrals sum(const std::vector<VolumeIntegrals>& parts) {
    VolumeIntegrals out;
    for (const VolumeIntegrals& part : parts) {
        out.volume += part.volume;
        out.centre += part.volume * part.centre;
    }
    if (out.volume <= 0) return {};
    out.centre /= out.volume;
    for (const VolumeIntegrals& part : parts) {
        const Vec3 d = part.centre - out.centre;
        out.inertia +=
            part.inertia + part.volume * (d.squaredNorm() * Mat3::Identity() - d * d.transpose());
    }
    return out;
}

double hull_depth(const Hull& hull, const Vec3& p) {
    double least = std::numeric_limits<double>::infinity();
    for (const std::vector<int>& face : hull.faces) {
        const auto at = [&](size_t i) -> const Vec3& {
            return hull.vertices[static_cast<size_t>(face[i])];
        };
        const Vec3 normal = (at(1) - at(0)).cross(at(2) - at(0)).normalized();
        least = std::min(least, normal.dot(at(0) - p));
    }
    return hull.faces.empty() ? -1 : least;
}

}  // namespace

double metres(MeshUnit unit) {
    switch (unit) {
        case MeshUnit::m:
            return 1;
        case MeshUnit::cm:
            return 1e-2;
        case MeshUnit::mm:
            return 1e-3;
        case MeshUnit::inch:
            return 0.0254;
    }
    return 1;
}

Shape Shape::box(const Vec3& size) {
    Shape shape;
    shape.kind = ShapeKind::box;
    shape.size = size;
    return shape;
}

Shape Shape::sphere(double radius) {
    Shape shape;
    shape.kind = ShapeKind::sphere;
    shape.radius = radius;
    return shape;
}

VolumeIntegrals integrate(const Shape& shape) {
    const double r = shape.radius;
    const double l = shape.length;
    switch (shape.kind) {
        case ShapeKind::box: {
            const Vec3 sq = shape.size.cwiseAbs2();
            const double volume = shape.size.prod();
            return symmetric(volume,
                             volume / 12 * Vec3(sq.y() + sq.z(), sq.x() + sq.z(), sq.x() + sq.y()));
        }
        case ShapeKind::sphere: {
            const double volume = 4.0 / 3.0 * kPi * r * r * r;
            return symmetric(volume, Vec3::Constant(0.4 * volume * r * r));
        }
        case ShapeKind::cylinder: {
            const double volume = kPi * r * r * l;
            const double across = volume * (3 * r * r + l * l) / 12;
            return symmetric(volume, {across, across, volume * r * r / 2});
        }
        case ShapeKind::cone: {
            // the centre of volume of a cone is a quarter of its height above the base
            const double volume = kPi * r * r * l / 3;
            const double across = 3.0 / 80 * volume * (4 * r * r + l * l);
            VolumeIntegrals out = symmetric(volume, {across, across, 0.3 * volume * r * r});
            out.centre.z() = -l / 4;
            return out;
        }
        case ShapeKind::capsule: {
            // the cylinder between the caps, plus two half spheres, whose centres of volume are 3/8
            // r beyond the ends of the cylinder
            const double cylinder = kPi * r * r * l;
            const double caps = 4.0 / 3.0 * kPi * r * r * r;
            const double across = cylinder * (3 * r * r + l * l) / 12 +
                                  caps * (0.4 * r * r + l * l / 4 + 3.0 / 8.0 * l * r);
            return symmetric(cylinder + caps,
                             {across, across, cylinder * r * r / 2 + 0.4 * caps * r * r});
        }
        case ShapeKind::plane:
            return {};
        case ShapeKind::mesh:
            return shape.concave ? shape.solid : integrate(shape.hull.vertices, shape.hull.faces);
        case ShapeKind::compound: {
            std::vector<VolumeIntegrals> parts;
            for (const Part& part : shape.parts)
                parts.push_back(moved(integrate(part.shape), part.pose()));
            return sum(parts);
        }
    }
    return {};
}

double depth(const Shape& shape, const Vec3& p_B) {
    const double across = std::hypot(p_B.x(), p_B.y());
    switch (shape.kind) {
        case ShapeKind::box:
            return (shape.size / 2 - p_B.cwiseAbs()).minCoeff();
        case ShapeKind::sphere:
            return shape.radius - p_B.norm();
        case ShapeKind::cylinder:
            return std::min(shape.radius - across, shape.length / 2 - std::abs(p_B.z()));
        case ShapeKind::cone: {
            const double below_tip = shape.length / 2 - p_B.z();
            const double to_side = (shape.radius * below_tip - shape.length * across) /
                                   std::hypot(shape.radius, shape.length);
            return std::min(to_side, p_B.z() + shape.length / 2);
        }
        case ShapeKind::capsule:
            return shape.radius -
                   std::hypot(across, std::max(0.0, std::abs(p_B.z()) - shape.length / 2));
        case ShapeKind::plane:
            return -p_B.z();
        case ShapeKind::mesh: {
            if (!shape.concave) return hull_depth(shape.hull, p_B);
            double deepest = -std::numeric_limits<double>::infinity();
            for (const Hull& piece : shape.pieces.hulls)
                deepest = std::max(deepest, hull_depth(piece, p_B));
            return deepest;
        }
        case ShapeKind::compound: {
            double deepest = -std::numeric_limits<double>::infinity();
            for (const Part& part : shape.parts)
                deepest = std::max(deepest, depth(part.shape, part.pose().inverse() * p_B));
            return deepest;
        }
    }
    return -1;
}

std::vector<Vec3> marks(const Shape& shape) {
    std::vector<Vec3> out;
    if (shape.kind == ShapeKind::plane) return out;
    if (shape.kind == ShapeKind::mesh) {
        out = shape.hull.vertices;
        // the centre of a concave mesh may lie outside it
        if (!out.empty() && !shape.concave) out.push_back(integrate(shape).centre);
        return out;
    }
    if (shape.kind == ShapeKind::compound) {
        for (const Part& part : shape.parts) {
            for (const Vec3& p : marks(part.shape)) out.push_back(part.pose() * p);
        }
        return out;
    }
    out.emplace_back(Vec3::Zero());
    if (shape.kind == ShapeKind::box) {
        for (int i = 0; i < 8; ++i) {
            out.emplace_back(shape.size.cwiseProduct(
                Vec3((i & 1) - 0.5, (i >> 1 & 1) - 0.5, (i >> 2 & 1) - 0.5)));
        }
        return out;
    }
    const double along = shape.kind == ShapeKind::sphere    ? shape.radius
                         : shape.kind == ShapeKind::capsule ? shape.length / 2 + shape.radius
                                                            : shape.length / 2;
    const double widest = shape.kind == ShapeKind::cone ? -along : 0;
    for (const double side : {-1.0, 1.0}) {
        out.emplace_back(side * shape.radius, 0, widest);
        out.emplace_back(0, side * shape.radius, widest);
        out.emplace_back(0, 0, side * along);
    }
    return out;
}

Bounds bounds(const Shape& shape) {
    const auto about_origin = [](const Vec3& half) { return Bounds{-half, half}; };
    const double r = shape.radius;
    switch (shape.kind) {
        case ShapeKind::box:
            return about_origin(shape.size / 2);
        case ShapeKind::sphere:
            return about_origin(Vec3::Constant(r));
        case ShapeKind::cylinder:
        case ShapeKind::cone:
            return about_origin({r, r, shape.length / 2});
        case ShapeKind::capsule:
            return about_origin({r, r, r + shape.length / 2});
        case ShapeKind::plane:
            break;
        case ShapeKind::mesh:
        case ShapeKind::compound: {
            const std::vector<Vec3> points =
                shape.kind == ShapeKind::mesh ? shape.hull.vertices : marks(shape);
            if (points.empty()) break;
            Bounds out{points.front(), points.front()};
            for (const Vec3& v : points) {
                out.low = out.low.cwiseMin(v);
                out.high = out.high.cwiseMax(v);
            }
            return out;
        }
    }
    return {};
}

double extent(const Shape& shape) {
    const Bounds box = bounds(shape);
    return (box.high - box.low).maxCoeff();
}

std::vector<ConvexPart> convex_parts(const Shape& shape) {
    std::vector<ConvexPart> out;
    if (shape.kind == ShapeKind::compound) {
        for (const Part& part : shape.parts) {
            for (ConvexPart& convex : convex_parts(part.shape)) {
                convex.X_BS = part.pose() * convex.X_BS;
                out.push_back(std::move(convex));
            }
        }
    } else if (shape.kind == ShapeKind::mesh && shape.concave) {
        for (const Hull& piece : shape.pieces.hulls) {
            ConvexPart convex;
            convex.shape.kind = ShapeKind::mesh;
            convex.shape.hull = piece;
            out.push_back(std::move(convex));
        }
    } else {
        out.push_back({shape, Pose{}});
    }
    return out;
}

}  // namespace dihaptic::scene
