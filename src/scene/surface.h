// Describes how a surface slides, yields and bounces when it is touched.
#pragma once

#include <limits>
#include <optional>
#include <string>

#include "base/field_reader.h"
#include "scene/texture.h"

namespace dihaptic::scene {

/// Limits for a surface: bodies pass through softer ones, and harder ones count as rigid.
constexpr double kSoftest = 50;   // [N/m]
constexpr double kHardest = 1e6;  // [N/m]
constexpr double kMostFriction = 100;

/// The surface of a body, a finger or a pair. Properties that are unset do not exist for a body or
/// finger; for a pair, they are derived from its two surfaces.
struct Surface {
    std::optional<double> stiffness;         ///< stiffness of a pressed face [N/m]; rigid if unset
    std::optional<double> damping;           ///< damping in parallel to the stiffness [N*s/m]
    std::optional<double> restitution;       ///< coefficient of restitution in Newton's law, 0 to 1
    std::optional<double> dynamic_friction;  ///< coefficient while sliding; static one if unset
    std::optional<double> stribeck_speed;    ///< see friction_at() [m/s]
    std::optional<double> film;              ///< viscous drag of a sliding face [N*s/m]
    std::optional<Texture> texture;          ///< allowed for bodies, but not for fingers and pairs
    Place place;

    bool operator==(const Surface& other) const {
        return stiffness == other.stiffness && damping == other.damping &&
               restitution == other.restitution && dynamic_friction == other.dynamic_friction &&
               stribeck_speed == other.stribeck_speed && film == other.film &&
               texture == other.texture;
    }

    template <class Visitor>
    void visit(Visitor& v) {
        v("stiffness", stiffness,
          Field::of(Quantity::stiffness)
              .within(kSoftest, kHardest)
              .says("Stiffness of a pressed face, for soft objects; two soft faces are springs "
                    "in series. If left out, rigid."));
        v("damping", damping,
          Field::of(Quantity::damping).within(0, 1000).says("Damper parallel to the stiffness."));
        v("restitution", restitution,
          Field::number().within(0, 1).says(
              "Speed after a bounce over the speed before it, Newton's law; for two surfaces, the "
              "larger is used."));
        v("dynamic_friction", dynamic_friction,
          Field::number()
              .within(0, kMostFriction)
              .says("Coefficient of friction during sliding, at most the static one; for two "
                    "surfaces, the geometric mean is used."));
        v("stribeck_speed", stribeck_speed,
          Field::of(Quantity::speed)
              .within(1e-4, 10)
              .says("Sliding speed at which friction has fallen from the static to the dynamic "
                    "coefficient by 1 - 1/e; for two surfaces, the mean is used. If left out, 10 "
                    "mm/s."));
        v("film", film,
          Field::of(Quantity::damping)
              .within(0, 1000)
              .says("Viscous drag of a sliding face, in addition to friction; the drags of two "
                    "surfaces are added."));
        v("texture", texture, says("Variation of friction and height along a body's surface."));
    }
};

/// The combined properties of two surfaces that touch each other.
struct PairSurface {
    double friction = 0;          ///< static coefficient
    double dynamic_friction = 0;  ///< at most equal to the static coefficient
    double stribeck_speed = 0.01;
    double film = 0;
    double restitution = 0;
    double stiffness = std::numeric_limits<double>::infinity();
    double damping = 0;

    bool is_soft() const { return stiffness < std::numeric_limits<double>::infinity(); }
    bool slides_like_coulomb() const { return dynamic_friction == friction && film == 0; }

    /// Coefficient of friction at a sliding speed [m/s] and a normal force [N]. It is the sum of
    /// Stribeck's curve, which falls from the static to the dynamic coefficient, and the drag of
    /// the film.
    ///
    ///     mu_d + (mu_s - mu_d) exp(-(v / v_s)^2) + film v / N
    double friction_at(double speed, double normal_force) const noexcept;
};

/// The surface of one of the two bodies or fingers in a pair.
struct SurfaceOf {
    const std::string& name;
    double friction = 0;
    const Surface& surface;
};

struct Scene;

/// The combined surface of two bodies or fingers: the values that the file gives for the pair or,
/// otherwise, a combination of their own surfaces.
PairSurface pair_surface(const Scene& scene, const SurfaceOf& a, const SurfaceOf& b);

/// Checks that the keys of a surface are compatible with each other; `friction` is the static
/// coefficient of friction, if it is known.
void check(const Surface& surface, std::optional<double> friction, Diagnostics& diagnostics);

}  // namespace dihaptic::scene
