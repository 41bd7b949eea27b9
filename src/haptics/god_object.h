// The point proxy's place: a point that follows the handle and cannot enter any body. It is where
// the point would go by itself if it were pulled to the handle and rubbed against what it touches.
//
// In each tick the bodies move first, then the point:
//
//   carry   what it touched with friction takes it along (a mean by how hard it presses)
//   push    in each body's frame the point's own straight path of the tick is followed; where it
//           enters, the face that it came through becomes a constraint, and the nearest place that
//           obeys all of them is taken (half_spaces.h)
//   pull    straight toward the handle, to the first body in the way; then along it, and so on with
//           up to three bodies at once, until friction holds it or nothing nearer can be reached
//
// Each part is a path outside all bodies, so nothing is ever tunnelled, and the face that was
// entered stays the one that is felt: past a thin wedge's edge, too.
//
// Friction (Harwin and Melder 2002): with d the way that is still to go along the surfaces and l_i
// the handle's depth behind each, the point rests while |d| <= sum mu_i l_i; else it slides until
// |d| = r sum mu_i l_i. r < 1 makes it stick and slip.
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

/// Surfaces are felt so far outside of where they are: without, a point that slides along a table
/// would slip under a block that stands on it [m].
constexpr double kSkin = 1e-5;

/// What the point rests on: one face of a convex part of a body.
struct PointContact {
    size_t body = 0;
    size_t surface = 0;  ///< of all bodies' parts
    int face = 0;
    Vec3 n_W = Vec3::UnitZ();  ///< out of the body, unit
    double depth = 0;          ///< the handle's share behind it, l [m]
};

/// A face that the point may come up against.
struct Obstacle {
    size_t body = 0;
    size_t surface = 0;  ///< of all bodies' parts
    int face = 0;
    Vec3 n_W = Vec3::UnitZ();  ///< out of the body, unit
    double gap = 0;            ///< from the face, or its plane, to the point [m]
};

class GodObject {
  public:
    /// The scene's bodies by index, with the coefficient of static friction that each has with the
    /// point. `sliding`: dynamic friction over static friction.
    GodObject(std::span<const scene::Body> bodies, std::vector<double> friction, double sliding,
              double skin = kSkin);

    /// Puts the point somewhere. Bodies that it is inside of are not felt until it has left them.
    void place(const Vec3& p_W, std::span<const dynamics::BodyState> bodies) noexcept;
    /// One tick: the bodies are where `bodies` says, the handle is at p_WH.
    void follow(const Vec3& p_WH, std::span<const dynamics::BodyState> bodies) noexcept;

    /// The body is not felt until the point, which goes on to the handle, has left it.
    void pop_through(size_t body, const Vec3& p_WH) noexcept;

    // Where something else decides where the point goes: friction, and bodies that give way.

    /// What the point may come up against while it is pulled to `p_W` and bodies move on for h [s]:
    /// the faces that it is on, and those that it would meet without friction. One face a part.
    std::span<const Obstacle> obstacles(const Vec3& p_W,
                                        std::span<const dynamics::BodyState> bodies,
                                        double h) noexcept;
    /// One tick: the bodies are where `bodies` says, and the point goes straight to `p_W`, where a
    /// step of the world put it, but for what is in the way.
    void move(const Vec3& p_W, std::span<const dynamics::BodyState> bodies) noexcept;
    /// Toward the handle, along surfaces without friction, among bodies that stay where they are.
    void slide(const Vec3& p_WH) noexcept;

    const Vec3& position() const noexcept { return p_; }
    /// The same in the frame of a body, where it was in the last tick.
    Vec3 position_in(size_t body) const noexcept;
    std::span<const PointContact> contacts() const noexcept { return {contacts_.data(), count_}; }
    double friction(size_t body) const noexcept { return friction_scale_ * friction_[body]; }
    void set_friction_scale(double scale) noexcept { friction_scale_ = scale; }
    /// The way to the handle that is left along the surfaces: held by friction [m].
    const Vec3& held() const noexcept { return held_; }
    /// Whether it slid in the last tick; then friction is the dynamic one.
    bool sliding() const noexcept { return sliding_; }
    double sliding_ratio() const noexcept { return sliding_ratio_; }

  private:
    Vec3 carried(std::span<const dynamics::BodyState> bodies) const noexcept;
    double push_out(const Vec3& start, std::span<const dynamics::BodyState> bodies) noexcept;
    void pull(const Vec3& p_WH, bool rubs) noexcept;
    /// What ends a straight way: at most one of the two.
    struct Event {
        double share = 1;                     ///< of the way, until then
        std::optional<PointContact> meets;    ///< a body
        std::optional<PointContact> crosses;  ///< an edge, onto this face
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
    /// A point in the frame of a surface, where that was after the last push_out().
    Vec3 in_surface(size_t surface, const Vec3& p_W) const noexcept;
    /// Pose X_WS of a surface whose body is where `bodies` says.
    Pose pose(size_t surface, std::span<const dynamics::BodyState> bodies) const noexcept;

    /// The surface S of a convex part.
    struct PartSurface {
        size_t body;
        Pose X_BS;
        Surface surface;
    };
    std::vector<PartSurface> parts_;
    std::vector<double> friction_;  // by body
    double friction_scale_ = 1;
    double sliding_ratio_;
    std::vector<Pose> X_WS_;                     // by surface
    std::vector<char> inside_;                   // by body
    std::vector<size_t> near_;                   // surfaces
    std::vector<dynamics::BodyState> coming_;    // scratch
    std::array<Obstacle, kMostHalfSpaces> met_;  // since it was cleared, one face a surface
    size_t met_count_ = 0;
    Vec3 p_ = Vec3::Zero();
    Vec3 held_ = Vec3::Zero();
    std::array<PointContact, kMostHalfSpaces> contacts_;
    size_t count_ = 0;
    bool sliding_ = false;
};

}  // namespace dihaptic::haptics
