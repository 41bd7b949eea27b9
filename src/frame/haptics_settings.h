// The haptic rendering settings that an experiment can choose.
#pragma once

#include <algorithm>
#include <array>
#include <optional>
#include <string>

#include "base/field.h"
#include "scene/proxy_kind.h"

namespace dihaptic::frame {

/// Upper limits. The stiffest admittance displays render about 5e4 N/m and 1e3 N*s/m, and no hand
/// needs to bear more than a kilonewton.
constexpr double kMostStiffness = 1e5;  // [N/m]
constexpr double kMostDamping = 1000;   // [N*s/m]
constexpr double kMostForce = 1000;     // [N]

enum class CouplingKind { implicit, dual_spring, velocity_impulse };
constexpr auto enum_names(CouplingKind) {
    return std::array{"implicit", "dual_spring", "velocity_impulse"};
}

/// The coupling between a handle and its proxy; src/haptics/README.md gives the equations.
struct CouplingSettings {
    CouplingKind kind = CouplingKind::implicit;
    double stiffness = 1000;        ///< k [N/m]
    std::optional<double> damping;  ///< c [N*s/m]; if unset, k h / 2, where h is the dynamics step
    /// Stiffness and damping as fractions of the largest values that the devices render calmly.
    /// Once these values are known, the fractions are converted to N/m and N*s/m, and reset.
    std::optional<double> stiffness_share;
    std::optional<double> damping_share;
    double turn_stiffness = 1;           ///< k_r, used if the device measures orientation [N*m/rad]
    std::optional<double> turn_damping;  ///< c_r [N*m*s/rad]; if unset, k_r h / 2
    double onset = 0;  ///< time from first touch to full stiffness and damping [s]; 0: no delay

    // only for the dual spring
    double body_mass = 0.02;  ///< replaces the proxy's own mass; an explicit spring with k above
                              ///< about m / h^2 diverges [kg]
    double body_damping_along = 2;   ///< c_b,par, along the line from handle to proxy [N*s/m]
    double body_damping_across = 2;  ///< c_b,perp, perpendicular to that line [N*s/m]
    double free_stiffening = 10;     ///< k_b / k, used while the proxy touches nothing
    double smoothing =
        0.2;  ///< alpha, the weight of the new force in the force sent; 1: no smoothing

    bool operator==(const CouplingSettings&) const = default;

    template <class Visitor>
    void visit(Visitor& v) {
        v("kind", kind, says("Law of the coupling."));
        v("stiffness", stiffness,
          Field::of(Quantity::stiffness)
              .within(1, kMostStiffness)
              .says("Stiffness k of the coupling."));
        v("damping", damping,
          Field::of(Quantity::damping)
              .within(0, kMostDamping)
              .says("Damping of the coupling; if left out, k h / 2, with h the world's step."));
        v("stiffness_share", stiffness_share,
          Field::number().positive().at_most(1).says(
              "Stiffness as a fraction of the largest that the devices render calmly."));
        v("damping_share", damping_share,
          Field::number().within(0, 1).says(
              "Damping as a fraction of the largest that the devices render calmly."));
        if constexpr (requires { v.diagnostics(); }) {
            one_of_two(v, "stiffness", Quantity::stiffness, stiffness_share);
            one_of_two(v, "damping", Quantity::damping, damping_share);
        }
        v("turn_stiffness", turn_stiffness,
          Field::of(Quantity::turn_stiffness)
              .within(1e-4, 1000)
              .says("Rotational stiffness k_r, if the device measures orientation."));
        v("turn_damping", turn_damping,
          Field::of(Quantity::turn_damping)
              .within(0, 10)
              .says("Rotational damping; if left out, k_r h / 2."));
        v("onset", onset,
          Field::of(Quantity::time)
              .within(0, 1)
              .says("Time from first touch to full stiffness; 0: at once."));
        v("body_mass", body_mass,
          Field::of(Quantity::mass).within(1e-4, 10).says("Mass of the proxy in a dual spring."));
        v("body_damping_along", body_damping_along,
          Field::of(Quantity::damping)
              .within(0, kMostDamping)
              .says("Damping of a dual spring along the line from handle to proxy."));
        v("body_damping_across", body_damping_across,
          Field::of(Quantity::damping)
              .within(0, kMostDamping)
              .says("Damping of a dual spring across the line from handle to proxy."));
        v("free_stiffening", free_stiffening,
          Field::number().within(1, 100).says("Factor on a dual spring's stiffness toward the "
                                              "proxy while the proxy touches nothing."));
        v("smoothing", smoothing,
          Field::number().within(0.001, 1).says(
              "Fraction of the new force in the force that a dual spring sends; 1: no smoothing."));
    }

  private:
    /// A value and the same value as a fraction are two forms of one setting. The later file takes
    /// precedence, and a single file may contain only one of the forms.
    template <class Reader>
    static void one_of_two(Reader& v, const std::string& name, Quantity quantity,
                           std::optional<double>& share) {
        if (!v.has(name, quantity)) return;
        if (v.has(name + "_share")) {
            v.diagnostics().error(
                v.place_of(name + "_share"), name + "_share",
                "the same " + name + " is also given as " + si_key(name, quantity) + "",
                "Keep one of the two.");
        }
        share.reset();
    }
};

/// Where the friction of a point proxy is computed: in the step of the world, together with all
/// bodies on which the friction acts, or separately, as in OpenHaptics' HL.
enum class PointFriction { together, apart };
constexpr auto enum_names(PointFriction) {
    return std::array{"together", "apart"};
}

/// How fingers are represented in the world.
struct ProxySettings {
    scene::ProxyKind kind = scene::ProxyKind::rigid;   ///< kind of proxy for fingers whose kind is
                                                       ///< not given by the scene
    PointFriction friction = PointFriction::together;  ///< point
    double sliding_friction = 1;  ///< for a point: ratio of dynamic to static friction
    /// For a point: a body that is pressed harder than this yields, and is not felt again until the
    /// point has left the body [N]. If unset, no body yields.
    std::optional<double> popthrough;
    bool changeable = false;  ///< whether the user may change the kind during a session

    template <class Visitor>
    void visit(Visitor& v) {
        v("kind", kind,
          says("Whether a finger is a rigid body or a point kept on "
               "surfaces, unless the scene gives the finger's kind."));
        v("friction", friction,
          says("Whether a point's friction is solved together with the dynamics or separately."));
        v("sliding_friction", sliding_friction,
          Field::number().within(0, 1).says(
              "Dynamic friction of a point, as a fraction of static friction."));
        v("popthrough", popthrough,
          Field::of(Quantity::force)
              .within(0.01, kMostForce)
              .says("Force beyond which a body yields to a point; if left out, no body yields."));
        v("changeable", changeable, says("Whether the kind can change during a session."));
    }

    /// Returns the kind of a finger's proxy, given the kind that is set for this finger, if any.
    scene::ProxyKind of(const std::optional<scene::ProxyKind>& own) const {
        return own.value_or(kind);
    }
};

enum class EnergyGuardMode { off, warn, act };
constexpr auto enum_names(EnergyGuardMode) {
    return std::array{"off", "warn", "act"};
}

/// Time within which a force that is no longer requested falls to zero [s]; the Limiter ensures
/// this. A slower decrease would push a hand that no longer touches anything for longer than it
/// takes to notice this.
constexpr double kLongestFall = 0.1;
/// Rates that bring a Premium's 8.5 N and the sigma.7's 0.4 N*m to zero within kLongestFall.
constexpr double kLeastForceRate = 85;  // [N/s]
constexpr double kLeastTorqueRate = 4;  // [N*m/s]

/// Limits on every force, whatever its source, and conditions that switch force off.
struct SafetySettings {
    std::optional<double> max_force;   ///< magnitude [N]; if unset, the device's peak force
    double max_force_rate = 3000;      ///< magnitude of the rate of change of the force [N/s]
    std::optional<double> max_torque;  ///< magnitude [N*m]; if unset, the device's peak torque
    double max_torque_rate =
        150;  ///< magnitude of the rate of change of the torque: max_force_rate at 5 cm [N*m/s]
    double max_speed = 10;  ///< maximum speed of a handle; a throwing hand reaches a few m/s [m/s]
    /// Longest time between two ticks, during which the last force is held; must be longer than any
    /// tick [s].
    double max_pause = 0.04;
    /// Longest delay of the start of a tick [s]; if unset, only `max_pause` applies.
    std::optional<double> max_late;
    /// Damping of handle and hand together, which determines the stiffness that is allowed when the
    /// loop is late [N*s/m]; if unset, the values of the devices or of a loose hand are used.
    std::optional<double> hand_damping;
    /// Time constant with which the device's motors heat up and cool down, about that of a small
    /// motor's winding [s].
    double heating_time = 10;
    double workspace_stiffness = 500;  ///< wall at the limit of reach; 0: no wall [N/m]
    double soft_start = 0.5;           ///< time over which force rises after it is switched on [s]
    std::string dead_man_finger;  ///< finger whose device has the dead-man switch; empty if there
                                  ///< is no switch
    int dead_man_button = 0;      ///< index of the switch among the device's buttons
    EnergyGuardMode energy_guard = EnergyGuardMode::warn;

    /// Returns the limit on the magnitude of the force for a device with this peak force, if both
    /// are `scale` times as large as what the hand feels [N].
    double largest_force(double peak, double scale = 1) const {
        return max_force ? std::min(*max_force * scale, peak) : peak;
    }
    /// Returns the limit on the magnitude of the torque for a device with this peak torque [N*m].
    double largest_torque(double peak) const { return std::min(max_torque.value_or(peak), peak); }

    template <class Visitor>
    void visit(Visitor& v) {
        const auto limit = [](Quantity quantity, double low, double high,
                              Tighter way = Tighter::less) {
            return Field::of(quantity).within(low, high).tighter_when(way);
        };
        v("max_force", max_force,
          limit(Quantity::force, 0.01, kMostForce)
              .says("Largest force; if left out, the device's peak force."));
        v("max_force_rate", max_force_rate,
          limit(Quantity::force_rate, kLeastForceRate, 1e6)
              .says("Largest rate of change of a force, except when it falls to zero."));
        v("max_torque", max_torque,
          limit(Quantity::torque, 1e-4, 100)
              .says("Largest torque; if left out, the device's peak torque."));
        v("max_torque_rate", max_torque_rate,
          limit(Quantity::torque_rate, kLeastTorqueRate, 1e5)
              .says("Largest rate of change of a torque, except when it falls to zero."));
        v("max_speed", max_speed,
          limit(Quantity::speed, 1e-3, 100)
              .says("Speed of a handle above which force is switched off."));
        v("max_pause", max_pause,
          limit(Quantity::time, 0.02, 1)
              .says("Time between two ticks above which force is switched off."));
        v("max_late", max_late,
          limit(Quantity::time, 1e-4, 1)
              .says("Lateness of a tick above which force is switched off; if left out, only "
                    "max_pause applies."));
        v("hand_damping", hand_damping,
          limit(Quantity::damping, 0.1, 100, Tighter::fixed)
              .says("Damping of handle and hand, which determines the stiffness allowed for a late "
                    "loop; if left out, the device's."));
        v("heating_time", heating_time,
          limit(Quantity::time, 1, 1000).says("Time constant of the device's motors."));
        v("workspace_stiffness", workspace_stiffness,
          limit(Quantity::stiffness, 0, 2000, Tighter::more)
              .says("Stiffness of the wall at the limit of a device's reach; 0: no wall."));
        v("soft_start", soft_start,
          limit(Quantity::time, 0, 10, Tighter::more)
              .says("Time over which force rises from zero after being switched on; 0: at once."));
        // a dead-man switch required by the rig cannot be changed
        v("dead_man_finger", dead_man_finger,
          says("Finger whose device has the dead-man switch; if left out, there is none."));
        v("dead_man_button", dead_man_button,
          Field::number().within(0, 31).says("Button of that device, counted from 0."));
        v("energy_guard", energy_guard,
          Field::number()
              .tighter_when(Tighter::more)
              .says("Whether energy that a coupling generates is ignored, recorded, or damped as "
                    "well."));
    }
};

}  // namespace dihaptic::frame
