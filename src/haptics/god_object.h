// GodObject computes the position of a point proxy: a point that follows the handle and cannot
// enter any body. It is where the point would go if it were pulled to the handle and rubbed against
// what it touches.
//
// In each tick the bodies move first, then the point:
//
//   carry   bodies that it touches with friction take it along (mean by how hard each is pressed)
//   push    in each body's frame the point's own straight path of the tick is followed; where it
//           enters, the face that it came through becomes a constraint, and the nearest position
//           that satisfies all constraints is taken (half_spaces.h)
//   pull    straight toward the handle, to the first body in the way; then along it, and so on with
//           up to three bodies at once, until friction holds it or it can get no nearer
//
// Each part is a path outside all bodies, so there is no tunnelling, and the face that was entered
// remains the one that is felt, even past a thin wedge's edge.
//
// Friction (Harwin and Melder 2002): with d the way left along the surfaces and l_i the depth of
// the handle behind each, the point rests while |d| <= sum mu_i l_i; otherwise it slides until |d|
// = r sum mu_i l_i. r < 1 makes it stick and slip.
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

/// Surfaces are felt this far outside the bodies: otherwise a point that slides along a table would
/// slip under a block that stands on it [m].
constexpr double kSkin = 1e-5;

/// A contact of the point: one face of a convex part of a body.
struct PointContact {
    size_t body = 0;
    size_t surface = 0;  ///< index among the parts of all bodies
    int face = 0;
    Vec3 n_W = Vec3::UnitZ();  ///< out of the body, unit
    double depth = 0;          ///< the handle's share behind it, l [m]
};

/// A face that the point may come up against.
struct Obstacle {
    size_t body = 0;
    size_t surface = 0;  ///< index among the parts of all bodies
    int face = 0;
    Vec3 n_W = Vec3::UnitZ();  ///< out of the body, unit
    double gap = 0;            ///< from the face, or its plane, to the point [m]
};

class GodObject {
  public:
    /// `bodies` are the scene's, by index; `friction` is the coefficient of static friction of each
    /// with the point, `sliding` dynamic over static friction.
    GodObject(std::span<const scene::Body> bodies, std::vector<double> friction, double sliding,
              double skin = kSkin);

    /// Puts the point somewhere. Bodies around it are not felt until it has left them.
    void place(const Vec3& p_W, std::span<const dynamics::BodyState> bodies) noexcept;
    /// Does one tick, with the bodies where `bodies` says and the handle at p_WH.
    void follow(const Vec3& p_WH, std::span<const dynamics::BodyState> bodies) noexcept;

    /// Makes a body unfelt until the point, which goes on to the handle, has left it.
    void pop_through(size_t body, const Vec3& p_WH) noexcept;

    // The following functions are for points whose position is computed elsewhere, by friction and
    // by bodies that give way.

    /// The faces that the point may come up against while it is pulled to `p_W` and bodies move on
    /// for h [s]: those that it is on, and those that it would meet without friction; one per part.
    std::span<const Obstacle> obstacles(const Vec3& p_W,
                                        std::span<const dynamics::BodyState> bodies,
                                        double h) noexcept;
    /// Does one tick, with the bodies where `bodies` says: the point goes straight to `p_W`, where
    /// a step of the world put it, unless something is in the way.
    void move(const Vec3& p_W, std::span<const dynamics::BodyState> bodies) noexcept;
    /// Moves toward the handle, along surfaces without friction, among bodies that stay in place.
    void slide(const Vec3& p_WH) noexcept;

    const Vec3& position() const noexcept { return p_; }
    /// The position in the frame of a body, taken at its pose of the last tick.
    Vec3 position_in(size_t body) const noexcept;
    std::span<const PointContact> contacts() const noexcept { return {contacts_.data(), count_}; }
    double friction(size_t body) const noexcept { return friction_[body]; }
    void set_friction(size_t body, double friction) noexcept { friction_[body] = friction; }
    /// The way left to the handle along the surfaces, which friction withholds [m].
    const Vec3& held() const noexcept { return held_; }
    /// Whether the point slid in the last tick, so that dynamic friction applies.
    bool sliding() const noexcept { return sliding_; }
    double sliding_ratio() const noexcept { return sliding_ratio_; }

  private:
    Vec3 carried(std::span<const dynamics::BodyState> bodies) const noexcept;
    double push_out(const Vec3& start, std::span<const dynamics::BodyState> bodies) noexcept;
    void pull(const Vec3& p_WH, bool rubs) noexcept;
    /// What ends a straight path: at most one of `meets` and `crosses`.
    struct Event {
        double share = 1;                     ///< of the way covered by then
        std::optional<PointContact> meets;    ///< a body in the way
        std::optional<PointContact> crosses;  ///< an edge, beyond which is this face
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
    /// A point in the frame of a surface, as of the last push_out().
    Vec3 in_surface(size_t surface, const Vec3& p_W) const noexcept;
    /// Pose X_WS of a surface, with its body where `bodies` says.
    Pose pose(size_t surface, std::span<const dynamics::BodyState> bodies) const noexcept;

    /// A convex part with its surface S.
    struct PartSurface {
        size_t body;
        Pose X_BS;
        Surface surface;
    };
    std::vector<PartSurface> parts_;
    std::vector<double> friction_;  // by body
    double sliding_ratio_;
    std::vector<Pose> X_WS_;                     // by surface
    std::vector<char> inside_;                   // by body
    std::vector<size_t> near_;                   // surfaces
    std::vector<dynamics::BodyState> coming_;    // scratch
    std::array<Obstacle, kMostHalfSpaces> met_;  // since last cleared, one face per surface
    size_t met_count_ = 0;
    Vec3 p_ = Vec3::Zero();
    Vec3 held_ = Vec3::Zero();
    std::array<PointContact, kMostHalfSpaces> contacts_;
    size_t count_ = 0;
    bool sliding_ = false;
};

}  // namespace dihaptic::haptics
