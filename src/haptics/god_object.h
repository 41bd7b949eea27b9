// GodObject computes the position of a point proxy, i.e. a point that follows the handle and cannot
// enter any body. The position is where a point would move if it were pulled to the handle and
// rubbed against the bodies that it touches.
//
// In each tick, the bodies move first, then the point does:
//
//   carry   bodies touched with friction carry it along (mean weighted by pressure)
//   push    in each body's frame the point's own straight path in the tick is followed; where it
//           enters, the face crossed becomes a constraint, and the nearest position
//           that satisfies all constraints is taken (half_spaces.h)
//   pull    straight toward the handle, to the first body in its path; then along it, and so
//           on with up to three bodies at once, until friction holds it or it cannot get nearer
//
// Each of these three motions is a path outside all bodies, so there is no tunnelling, and the face
// of entry remains the face that is felt, even past the edge of a thin wedge.
//
// Friction (Harwin and Melder 2002): with d the remaining path along the surfaces and l_i the depth
// of the handle behind surface i, the point rests while |d| <= sum mu_i l_i; otherwise it slides
// until |d| = r sum mu_i l_i. With r < 1, the point sticks and slips.
//
// Sources: Zilles and Salisbury 1995 (active constraints); Ruspini, Kolarov and Khatib 1997 (paths
// and pushing by moving bodies).
#pragma once

#include <array>
#include <optional>
#include <span>

#include "dynamics/world.h"
#include "haptics/half_spaces.h"
#include "haptics/surface.h"

namespace dihaptic::haptics {

/// Distance outside the bodies at which surfaces are felt. Without it, a point that slides along a
/// table would slip under a block that stands on it [m].
constexpr double kSkin = 1e-5;

/// A contact of the point with one face of a convex part of a body.
struct PointContact {
    size_t body = 0;
    size_t surface = 0;  ///< index of the part among the parts of all bodies
    int face = 0;
    Vec3 n_W = Vec3::UnitZ();  ///< unit normal, out of the body
    double depth = 0;          ///< depth l of the handle behind the face [m]
};

/// A face that the point may meet.
struct Obstacle {
    size_t body = 0;
    size_t surface = 0;  ///< index of the part among the parts of all bodies
    int face = 0;
    Vec3 n_W = Vec3::UnitZ();  ///< unit normal, out of the body
    double gap = 0;            ///< distance of the point from the face, or from its plane [m]
};

class GodObject {
  public:
    /// `bodies` are the bodies of the scene, in order. `friction` contains the static friction
    /// coefficient of each body with the point, and `sliding` is the ratio of dynamic to static
    /// friction.
    GodObject(std::span<const scene::Body> bodies, std::vector<double> friction, double sliding,
              double skin = kSkin);

    /// Places the point. A body that surrounds it is not felt until the point has left that body.
    void place(const Vec3& p_W, std::span<const dynamics::BodyState> bodies) noexcept;
    /// Computes one tick, given the states of the bodies and the position p_WH of the handle.
    void follow(const Vec3& p_WH, std::span<const dynamics::BodyState> bodies) noexcept;

    /// Makes a body imperceptible until the point, which continues towards the handle, has left it.
    void pop_through(size_t body, const Vec3& p_WH) noexcept;

    // The following functions are for points whose position is computed elsewhere, taking friction
    // and the compliance of bodies into account.

    /// Returns the faces that the point may meet while it is pulled to `p_W` and bodies move for h
    /// [s]: the faces that it touches, and those that it would meet if it moved without friction;
    /// at most one per part.
    std::span<const Obstacle> obstacles(const Vec3& p_W,
                                        std::span<const dynamics::BodyState> bodies,
                                        double h) noexcept;
    /// Computes one tick, given the states of the bodies: the point moves straight to `p_W`, the
    /// result of a step of the world, unless a body is in its path.
    void move(const Vec3& p_W, std::span<const dynamics::BodyState> bodies) noexcept;
    /// Moves towards the handle, along surfaces without friction, while all bodies stay in place.
    void slide(const Vec3& p_WH) noexcept;

    const Vec3& position() const noexcept { return p_; }
    /// The position of the point in the frame of a body, at the pose that the body had in the last
    /// tick.
    Vec3 position_in(size_t body) const noexcept;
    std::span<const PointContact> contacts() const noexcept { return {contacts_.data(), count_}; }
    double friction(size_t body) const noexcept { return friction_[body]; }
    void set_friction(size_t body, double friction) noexcept { friction_[body] = friction; }
    /// The remaining path to the handle along the surfaces, which is prevented by friction [m].
    const Vec3& held() const noexcept { return held_; }
    /// Whether the point slid in the last tick, so that dynamic friction applies.
    bool sliding() const noexcept { return sliding_; }
    double sliding_ratio() const noexcept { return sliding_ratio_; }

  private:
    Vec3 carried(std::span<const dynamics::BodyState> bodies) const noexcept;
    double push_out(const Vec3& start, std::span<const dynamics::BodyState> bodies) noexcept;
    void pull(const Vec3& p_WH, bool rubs) noexcept;
    /// The end of a straight path. At most one of `meets` and `crosses` is set.
    struct Event {
        double share = 1;                     ///< fraction of the path up to the event
        std::optional<PointContact> meets;    ///< a body in the path
        std::optional<PointContact> crosses;  ///< an edge, and the face beyond it
    };
    Event first_event(const Vec3& way) const noexcept;
    void leave_behind(const Event& event) noexcept;
    void go_past_edge(const PointContact& next, const Vec3& p_WH) noexcept;
    void leave_unpressed() noexcept;
    void leave_insides() noexcept;
    void gather(const Vec3& p_WH) noexcept;
    bool touch(const PointContact& contact) noexcept;
    void note(size_t surface, int face) noexcept;
    void untouch(size_t i) noexcept;
    void refresh_normals() noexcept;
    Vec3 way_to(const Vec3& p_WH) noexcept;
    double friction_depth() const noexcept;
    Vec3 straightened(const Vec3& way) const noexcept;
    /// Transforms a point to the frame of a surface at its pose in the last push_out().
    Vec3 in_surface(size_t surface, const Vec3& p_W) const noexcept;
    /// Pose X_WS of a surface, given the states of the bodies.
    Pose pose(size_t surface, std::span<const dynamics::BodyState> bodies) const noexcept;

    /// A convex part of a body, with its surface S.
    struct PartSurface {
        size_t body;
        Pose X_BS;
        Surface surface;
    };
    std::vector<PartSurface> parts_;
    std::vector<double> friction_;  // one per body
    double sliding_ratio_;
    std::vector<Pose> X_WS_;                     // one per surface
    std::vector<char> inside_;                   // one per body
    std::vector<size_t> near_;                   // indices of surfaces
    std::vector<dynamics::BodyState> coming_;    // scratch
    std::array<Obstacle, kMostHalfSpaces> met_;  // obstacles met since last cleared
    size_t met_count_ = 0;
    Vec3 p_ = Vec3::Zero();
    Vec3 held_ = Vec3::Zero();
    std::array<PointContact, kMostHalfSpaces> contacts_;
    size_t count_ = 0;
    bool sliding_ = false;
};

}  // namespace dihaptic::haptics
