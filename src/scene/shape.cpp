#include "scene/shape.h"

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
