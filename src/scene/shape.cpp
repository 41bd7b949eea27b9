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

}  // namespace

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
        case ShapeKind::capsule: {
            // the cylinder between the caps, and two half spheres, each with its centre of volume
            // 3/8 r beyond the cylinder's end
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
            return integrate(shape.hull.vertices, shape.hull.faces);
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
        case ShapeKind::capsule:
            return shape.radius -
                   std::hypot(across, std::max(0.0, std::abs(p_B.z()) - shape.length / 2));
        case ShapeKind::plane:
            return -p_B.z();
        case ShapeKind::mesh: {
            double least = std::numeric_limits<double>::infinity();
            for (const std::vector<int>& face : shape.hull.faces) {
                const auto at = [&](size_t i) -> const Vec3& {
                    return shape.hull.vertices[static_cast<size_t>(face[i])];
                };
                const Vec3 normal = (at(1) - at(0)).cross(at(2) - at(0)).normalized();
                least = std::min(least, normal.dot(at(0) - p_B));
            }
            return shape.hull.faces.empty() ? -1 : least;
        }
    }
    return -1;
}

std::vector<Vec3> marks(const Shape& shape) {
    std::vector<Vec3> out;
    if (shape.kind == ShapeKind::plane) return out;
    if (shape.kind == ShapeKind::mesh) {
        out = shape.hull.vertices;
        if (!out.empty()) out.push_back(integrate(shape).centre);
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
    for (const double side : {-1.0, 1.0}) {
        out.emplace_back(side * shape.radius, 0, 0);
        out.emplace_back(0, side * shape.radius, 0);
        out.emplace_back(0, 0, side * along);
    }
    return out;
}

double extent(const Shape& shape) {
    switch (shape.kind) {
        case ShapeKind::box:
            return shape.size.maxCoeff();
        case ShapeKind::sphere:
            return 2 * shape.radius;
        case ShapeKind::cylinder:
            return std::max(2 * shape.radius, shape.length);
        case ShapeKind::capsule:
            return 2 * shape.radius + shape.length;
        case ShapeKind::plane:
            return 0;
        case ShapeKind::mesh: {
            if (shape.hull.vertices.empty()) return 0;
            Vec3 low = shape.hull.vertices.front();
            Vec3 high = low;
            for (const Vec3& v : shape.hull.vertices) {
                low = low.cwiseMin(v);
                high = high.cwiseMax(v);
            }
            return (high - low).maxCoeff();
        }
    }
    return 0;
}

}  // namespace dihaptic::scene
