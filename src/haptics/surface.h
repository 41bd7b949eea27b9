// Surface represents the surface of a convex shape for a point proxy. It computes where a straight
// path enters the solid, which face keeps the point out there, and where a path along that face
// leaves it.
//
// A polyhedron has the faces of its hull; a cylinder has its side and two ends, and a cone its side
// and its base; sphere, capsule and plane have one face. All vectors are in the frame of the
// shape's body B.
#pragma once

#include <optional>
#include <vector>

#include "scene/shape.h"

namespace dihaptic::haptics {

/// A point within this distance of a surface is on the surface [m]. This is the accuracy of
/// positions; with a stiffness of 10 000 N/m it corresponds to 10 uN.
constexpr double kOnSurface = 1e-9;

/// Where two parts of a body share a plane, rounding errors leave a step at which a sliding point
/// would stop. Therefore, if a point enters a part through a side face, no deeper than this below
/// another face, it is treated as entering through that other face [m].
constexpr double kSeam = 1e-7;

class Surface {
  public:
    /// Creates the surface of a shape whose faces are moved outward by `skin` [m]. `has_seams`
    /// tells whether the shape is a part of a body whose other parts continue its faces; see kSeam.
    Surface(const scene::Shape& shape, double skin, bool has_seams = false);

    /// Distance of p from the solid [m]: negative inside; outside, a lower bound.
    double separation(const Vec3& p_B) const noexcept;

    struct Entry {
        double share = 0;  ///< fraction of the path covered at the entry
        int face = -1;     ///< face through which the path enters
    };
    /// Finds where the straight path p + s d, 0 <= s <= 1, enters the solid. Returns nullopt if it
    /// does not. A point on or below the surface enters at once, unless d leads along a face there
    /// or away from it.
    std::optional<Entry> enter(const Vec3& p_B, const Vec3& d_B) const noexcept;
    /// The face nearest to a point p inside the solid.
    int shallowest(const Vec3& p_B) const noexcept;
    /// Outward unit normal of a face at the point nearest to p.
    Vec3 normal(int face, const Vec3& p_B) const noexcept;
    /// Signed distance of p from a face, or from its plane [m].
    double distance(int face, const Vec3& p_B) const noexcept;

    struct Crossing {
        double share = 1;  ///< fraction of the path covered when it ends or leaves the face
        int face = -1;     ///< face beyond the edge, or -1 if the path stays on the face
    };
    /// Finds the part of a path along a face that stays over the face.
    Crossing cross(int face, const Vec3& p_B, const Vec3& d_B) const noexcept;

    /// The component of a tangent d in the direction in which a face is curved at p; zero if the
    /// face is flat. bend_radius() is the radius of this curvature [m].
    Vec3 bent_part(int face, const Vec3& p_B, const Vec3& d_B) const noexcept;
    double bend_radius(const Vec3& p_B) const noexcept;
    /// Whether all faces are flat.
    bool is_polyhedron() const noexcept { return !has_side() && !flats_.empty(); }

    /// Largest distance between B's origin and any point of the shape [m]; infinite for a plane.
    double reach() const noexcept { return reach_; }

  private:
    struct Flat {
        Vec3 n;         // unit outward normal
        double offset;  // n . x for points x on the face [m]
    };
    /// The side of a cylinder or a cone has c r + s z = radius_, where r is the distance from the
    /// axis, and c and s are the cosine and sine of the side's angle of inclination, which is 0 for
    /// a cylinder.
    struct Lean {
        double c = 1, s = 0;
    };
    bool is_cone() const { return kind_ == scene::ShapeKind::cone; }
    bool has_side() const { return kind_ == scene::ShapeKind::cylinder || is_cone(); }
    double side_distance(const Vec3& p_B) const noexcept;
    int faces() const { return static_cast<int>(flats_.size()) + (has_side() ? 1 : 0); }
    bool is_flat(int face) const { return face < static_cast<int>(flats_.size()); }
    Vec3 axis_point(const Vec3& p_B) const noexcept;
    std::optional<Entry> enter_ball(const Vec3& p_B, const Vec3& d_B) const noexcept;
    std::optional<Entry> enter_faces(const Vec3& p_B, const Vec3& d_B) const noexcept;

    std::optional<Entry> over_seams(std::optional<Entry> entry, const Vec3& p_B,
                                    const Vec3& d_B) const noexcept;

    scene::ShapeKind kind_;
    bool has_seams_;
    std::vector<Flat> flats_;  // faces of a polyhedron, ends of a cylinder, base of a cone, a plane
    Lean lean_;                // of the side of a cylinder or a cone
    double radius_ = 0;        // of a sphere, capsule or cylinder; for a cone, see Lean
    double base_radius_ = 0;   // radius of the ends of a cylinder, or of the base of a cone
    double half_ = 0;          // half the length of a capsule, cylinder or cone
    double reach_ = 0;
};

}  // namespace dihaptic::haptics
