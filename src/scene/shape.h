// Describes the shapes of bodies and proxies.
#pragma once

#include <array>
#include <memory>
#include <string>
#include <vector>

#include "base/diagnostics.h"
#include "base/field.h"
#include "base/geometry.h"
#include "scene/hull.h"
#include "scene/pieces.h"

namespace dihaptic::scene {

enum class ShapeKind { box, sphere, capsule, cylinder, cone, plane, mesh, compound };
constexpr auto enum_names(ShapeKind) {
    return std::array{"box", "sphere", "capsule", "cylinder", "cone", "plane", "mesh", "compound"};
}

/// The unit of the coordinates in a mesh file, which the file itself does not state.
enum class MeshUnit { m, cm, mm, inch };
constexpr auto enum_names(MeshUnit) {
    return std::array{"m", "cm", "mm", "inch"};
}

/// Length of one unit [m].
double metres(MeshUnit unit);

/// Limits for lengths, radii and meshes; beyond these limits, contacts are lost through rounding
/// [m].
constexpr double kSmallest = 1e-4;
constexpr double kLargest = 100;
/// Limit for rotations; beyond this limit, a unit is wrong [rad].
constexpr double kMostTurn = 100;

struct Part;

/// A shape in the frame of its body B. Boxes, spheres, capsules and cylinders are centred on B's
/// origin, and cones are centred on it at half their height. Capsules and cylinders lie along z,
/// and the tip of a cone is at its top. A plane is z = 0 and is solid below. A mesh is placed by
/// the coordinates in its file. A compound is the union of its parts.
struct Shape {
    ShapeKind kind = ShapeKind::box;
    Vec3 size = Vec3::Zero();  ///< box: edge lengths [m]
    double radius = 0;         ///< sphere, capsule, cylinder: radius; cone: radius of the base [m]
    double length = 0;         ///< cylinder, cone: height; capsule: distance of cap centres [m]
    std::string file;          ///< mesh: an OBJ, STL, PLY or OFF file, relative to the scene file
    std::string checksum;      ///< mesh: checksum of its file as it was read (base/checksum.h)
    MeshUnit unit = MeshUnit::m;
    bool concave = false;     ///< mesh: whether the mesh itself is felt rather than its convex hull
    std::vector<Part> parts;  ///< compound: at least one part; no part may be a plane or a compound
    Hull hull;                ///< mesh: its convex hull [m]
    Mesh surface;             ///< concave mesh: the closed mesh itself [m]
    Pieces pieces;            ///< concave mesh: convex pieces that fill it
    VolumeIntegrals solid;    ///< concave mesh: integrals over the union of its pieces
    Place file_place;         ///< mesh: where the scene file gives the mesh file
    Place unit_place;         ///< mesh: where the scene file gives the mesh's unit
    std::shared_ptr<const Mesh> coloured;  ///< mesh: as in its file, if its colours are drawn

    template <class Visitor>
    void visit(Visitor& v) {
        v("shape", kind,
          Field::text().required().says(
              "Shape; capsules and cylinders lie along z, a cone's tip is at the top of z, its "
              "origin in the middle of its height, and a plane is z = 0, solid below."));
        switch (kind) {
            case ShapeKind::box:
                v("size", size,
                  Field::length()
                      .within(kSmallest, kLargest)
                      .required()
                      .says("Lengths of the edges."));
                break;
            case ShapeKind::sphere:
                v("radius", radius,
                  Field::length().within(kSmallest, kLargest).required().says("Radius."));
                break;
            case ShapeKind::capsule:
            case ShapeKind::cylinder:
            case ShapeKind::cone:
                v("radius", radius,
                  Field::length().within(kSmallest, kLargest).required().says("Radius."));
                v("length", length,
                  Field::length()
                      .within(kSmallest, kLargest)
                      .required()
                      .says("Height of a cylinder or a cone; distance between the centres of a "
                            "capsule's caps."));
                break;
            case ShapeKind::plane:
                break;
            case ShapeKind::mesh:
                v("file", file,
                  Field::text().required().says(
                      "Mesh file (OBJ, STL, PLY or OFF), relative to this file."));
                v("unit", unit, Field::text().required().says("Unit of the mesh's coordinates."));
                v("concave", concave,
                  says("Whether the mesh itself is felt, instead of its convex hull."));
                if constexpr (requires { v.place(); }) {
                    file_place = v.place_of("file");
                    unit_place = v.place_of("unit");
                }
                break;
            case ShapeKind::compound:
                visit_parts(v);
                break;
        }
    }

    static Shape box(const Vec3& size);
    static Shape sphere(double radius);

  private:
    template <class Visitor>
    void visit_parts(Visitor& v);
};

/// A shape that is part of a compound.
struct Part {
    Shape shape;
    Vec3 position = Vec3::Zero();  ///< position of the part's origin in the body's frame [m]
    Vec3 rotation = Vec3::Zero();  ///< rotation about the body's axes x, then y, then z [rad]
    Place place;                   ///< where the scene file describes the part

    template <class Visitor>
    void visit(Visitor& v) {
        shape.visit(v);
        v("position", position,
          Field::length()
              .within(-kLargest, kLargest)
              .says("Position of the part's origin in the body."));
        v("rotation", rotation,
          Field::of(Quantity::angle)
              .within(-kMostTurn, kMostTurn)
              .says("Rotation of the part about the body's axes x, then y, then z."));
    }

    Pose pose() const { return {rotation_xyz(rotation), position}; }
};

template <class Visitor>
void Shape::visit_parts(Visitor& v) {
    v("parts", parts,
      Field::text().required().says("Component shapes, none of them a plane or a compound."));
}

/// A convex shape and its pose in its body B.
struct ConvexPart {
    Shape shape;
    Pose X_BS;
};

/// The convex components of a shape: the shape itself, the pieces of a concave mesh, or the convex
/// components of all parts.
std::vector<ConvexPart> convex_parts(const Shape& shape);

/// Volume integrals of the shape, for unit density. For a concave mesh, the integrals are over the
/// mesh itself. For a compound, they are summed over its parts, so overlaps count twice. A plane
/// has zero volume.
VolumeIntegrals integrate(const Shape& shape);

/// Depth of a point of B below the surface of the shape; negative if the point is outside [m].
double depth(const Shape& shape, const Vec3& p_B);
/// Points that represent the shape: its corners, or its farthest points along the axes, and, unless
/// it is a concave mesh, its centre. A plane has none.
std::vector<Vec3> marks(const Shape& shape);

/// The bounding box of a shape along the axes of its body [m]. For a compound, it is the bounding
/// box of marks(), which may cut off rotated round parts. It is zero for a plane.
struct Bounds {
    Vec3 low = Vec3::Zero();
    Vec3 high = Vec3::Zero();
};
Bounds bounds(const Shape& shape);

/// The largest extent of the shape along any axis [m]; 0 for a plane.
double extent(const Shape& shape);

}  // namespace dihaptic::scene
