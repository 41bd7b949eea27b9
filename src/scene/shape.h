// The shapes that bodies and proxies have.
#pragma once

#include <array>
#include <string>

#include "base/field.h"
#include "base/geometry.h"
#include "scene/hull.h"

namespace dihaptic::scene {

enum class ShapeKind { box, sphere, capsule, cylinder, plane, mesh };
constexpr auto enum_names(ShapeKind) {
    return std::array{"box", "sphere", "capsule", "cylinder", "plane", "mesh"};
}

/// The unit of a mesh file's coordinates, which the file itself does not tell.
enum class MeshUnit { m, cm, mm };
constexpr auto enum_names(MeshUnit) {
    return std::array{"m", "cm", "mm"};
}

/// A shape in the frame of its body B. Boxes, spheres, capsules and cylinders are centred on B's
/// origin; capsules and cylinders lie along z; a plane is z = 0, solid below; a mesh is where its
/// file puts it.
struct Shape {
    ShapeKind kind = ShapeKind::box;
    Vec3 size = Vec3::Zero();  ///< box: lengths of the edges [m]
    double radius = 0;         ///< sphere, capsule, cylinder [m]
    double length = 0;         ///< cylinder: height; capsule: between the centres of its caps [m]
    std::string file;          ///< mesh: OBJ, STL or PLY, relative to the scene file
    MeshUnit unit = MeshUnit::m;
    Hull hull;  ///< mesh: its convex hull, loaded [m]

    template <class Visitor>
    void visit(Visitor& v) {
        v("shape", kind, Field::text().required());
        switch (kind) {
            case ShapeKind::box:
                v("size", size, Field::length().positive().required());
                break;
            case ShapeKind::sphere:
                v("radius", radius, Field::length().positive().required());
                break;
            case ShapeKind::capsule:
            case ShapeKind::cylinder:
                v("radius", radius, Field::length().positive().required());
                v("length", length, Field::length().positive().required());
                break;
            case ShapeKind::plane:
                break;
            case ShapeKind::mesh:
                v("file", file, Field::text().required());
                v("unit", unit, Field::text().required());
                break;
        }
    }

    static Shape box(const Vec3& size);
    static Shape sphere(double radius);
};

/// Volume integrals of the shape, of unit density. A plane has none (zero volume).
VolumeIntegrals integrate(const Shape& shape);

/// Largest extent of the shape along any axis [m]; 0 for a plane.
double extent(const Shape& shape);

}  // namespace dihaptic::scene
