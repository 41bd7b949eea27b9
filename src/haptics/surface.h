// Surface is the surface of a convex shape for a point proxy: the entry of a straight path into the
// solid, the face that keeps the point out there, and the exit of a path along that face.
//
// A polyhedron has the faces of its hull; a cylinder has its side and two ends, and a cone its side
// and its base; sphere, capsule and plane have one face. Everything is in the frame of the shape's
// body B.
#pragma once

#include <optional>
#include <vector>

#include "scene/shape.h"

namespace dihaptic::haptics {

/// A point within this distance of a surface is on it: the accuracy of positions [m]. A stiffness
/// of 10 000 N/m turns it into 10 uN.
constexpr double kOnSurface = 1e-9;

/// Where two parts of a body share a plane, rounding leaves a step at which a sliding point would
/// stop. A point that enters a part through a side face, no deeper than this below another face,
/// enters through that other face [m].
constexpr double kSeam = 1e-7;

class Surface {
  public:
    /// The surface of a shape with its faces moved outward by `skin` [m]. `has_seams`: the shape is
    /// a part of a body whose other parts continue its faces; see kSeam.
    Surface(const scene::Shape& shape, double skin, bool has_seams = false);

    /// Distance of p outside the solid: negative inside, a lower bound outside [m].
    double separation(const Vec3& p_B) const noexcept;

    struct Entry {
        double share = 0;  ///< of the path covered at the entry
        int face = -1;     ///< face of entry
    };
    /// Where the straight path p + s d, 0 <= s <= 1, enters the solid; nullopt if it does not. A
    /// point on or below the surface enters at once unless d leads along a face there or away from
    /// it.
    std::optional<Entry> enter(const Vec3& p_B, const Vec3& d_B) const noexcept;
    /// The face nearest to p from inside.
    int shallowest(const Vec3& p_B) const noexcept;
    /// Outward unit normal at the point of a face that is nearest to p.
    Vec3 normal(int face, const Vec3& p_B) const noexcept;
    /// Signed distance of p from a face, or its plane [m].
    double distance(int face, const Vec3& p_B) const noexcept;

    struct Crossing {
        double share = 1;  ///< of the path covered at its end or exit from the face
        int face = -1;     ///< face beyond the edge; -1: the path stays on the face
    };
    /// The part of a path along a face that stays over it.
    Crossing cross(int face, const Vec3& p_B, const Vec3& d_B) const noexcept;

    /// The part of a tangent d along which a face is curved at p; zero where it is flat.
    /// bend_radius() is the radius of that curve [m].
    Vec3 bent_part(int face, const Vec3& p_B, const Vec3& d_B) const noexcept;
    double bend_radius(const Vec3& p_B) const noexcept;
    /// Whether no face is curved.
    bool is_polyhedron() const noexcept { return !has_side() && !flats_.empty(); }

    /// Largest distance of any point of the shape from B's origin; infinite for a plane [m].
    double reach() const noexcept { return reach_; }

  private:
    struct Flat {
        Vec3 n;         // outward, unit
        double offset;  // n . x on the face [m]
    };
    /// The side of a cylinder or a cone has c r + s z = radius_, with r the distance from the axis,
    /// and c and s cosine and sine of the side's angle of inclination, which is 0 for a cylinder.
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
    std::vector<Flat> flats_;  // of polyhedra, ends of a cylinder, base of a cone, the plane
    Lean lean_;                // of a side
    double radius_ = 0;        // sphere, capsule, cylinder; cone: see Lean
    double base_radius_ = 0;   // of the ends of cylinder and cone
    double half_ = 0;          // half the length of capsule, cylinder and cone
    double reach_ = 0;
};

}  // namespace dihaptic::haptics
