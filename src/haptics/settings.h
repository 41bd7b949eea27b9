// What an experiment may choose about haptic rendering.
#pragma once

#include <algorithm>
#include <array>
#include <optional>
#include <string>

#include "base/field.h"
#include "scene/scene.h"

namespace dihaptic::haptics {

enum class CouplingKind { implicit, dual_spring, velocity_impulse };
constexpr auto enum_names(CouplingKind) {
    return std::array{"implicit", "dual_spring", "velocity_impulse"};
}

/// What may change while a session runs.
struct Tuning {
    CouplingKind kind = CouplingKind::implicit;
    double stiffness = 0;           ///< k [N/m]
    std::optional<double> damping;  ///< c [N*s/m]; unset: k h / 2
    double smoothing = 0;           ///< alpha

    bool operator==(const Tuning&) const = default;
};

/// How a handle and its proxy pull at each other; equations in README.md.
struct CouplingSettings {
    CouplingKind kind = CouplingKind::implicit;
    double stiffness = 1000;        ///< k [N/m]
    std::optional<double> damping;  ///< c [N*s/m]; unset: k h / 2, h being the step of the dynamics
    /// The two as shares of what the devices render calmly; unset, once that is known and they are
    /// in N/m and N*s/m.
    std::optional<double> stiffness_share;
    std::optional<double> damping_share;
    double turn_stiffness = 1;           ///< k_r, where the device measures orientation [N*m/rad]
    std::optional<double> turn_damping;  ///< c_r [N*m*s/rad]; unset: k_r h / 2
    double onset = 0;  ///< from first touch to full stiffness and damping; 0: at once [s]

    // dual spring only
    double body_mass = 0.02;  ///< of the proxy, in place of its own: an explicit spring diverges
                              ///< above about m / h^2 [kg]
    double body_damping_along = 2;   ///< c_b,par: along the line from handle to proxy [N*s/m]
    double body_damping_across = 2;  ///< c_b,perp: across it [N*s/m]
    double free_stiffening = 10;     ///< k_b over k while the proxy touches nothing
    double smoothing = 0.2;  ///< alpha: share of the new force in the force sent; 1: no smoothing

    template <class Visitor>
    void visit(Visitor& v) {
        v("kind", kind);
        v("stiffness", stiffness, Field::of(Quantity::stiffness).positive());
        v("damping", damping, Field::of(Quantity::damping).at_least(0));
        v("stiffness_share", stiffness_share, Field::number().positive().at_most(1));
        v("damping_share", damping_share, Field::number().within(0, 1));
        if constexpr (requires { v.diagnostics(); }) {
            one_of_two(v, "stiffness", Quantity::stiffness, stiffness_share);
            one_of_two(v, "damping", Quantity::damping, damping_share);
        }
        v("turn_stiffness", turn_stiffness, Field::of(Quantity::turn_stiffness).positive());
        v("turn_damping", turn_damping, Field::of(Quantity::turn_damping).at_least(0));
        v("onset", onset, Field::of(Quantity::time).within(0, 1));
        v("body_mass", body_mass, Field::of(Quantity::mass).positive());
        v("body_damping_along", body_damping_along, Field::of(Quantity::damping).at_least(0));
        v("body_damping_across", body_damping_across, Field::of(Quantity::damping).at_least(0));
        v("free_stiffening", free_stiffening, Field::number().at_least(1));
        v("smoothing", smoothing, Field::number().positive().at_most(1));
    }

    Tuning tuning() const { return {kind, stiffness, damping, smoothing}; }
    void set(const Tuning& tuning) {
        kind = tuning.kind;
        stiffness = tuning.stiffness;
        damping = tuning.damping;
        smoothing = tuning.smoothing;
    }

  private:
    /// A value and its share are two spellings of one setting: the later file's counts, and a file
    /// has one of them.
    template <class Reader>
    static void one_of_two(Reader& v, const std::string& name, Quantity quantity,
                           std::optional<double>& share) {
        if (!v.has(name, quantity)) return;
        if (v.has(name + "_share")) {
            v.diagnostics().error(
                v.place_of(name + "_share"), name + "_share",
                "the same " + name + " is given as " + si_key(name, quantity) + " too",
                "Keep one of the two.");
        }
        share.reset();
    }
};

using scene::ProxyKind;

/// Where a point's friction is computed: in the step of the world, with all that it acts on, or
/// outside of it, as OpenHaptics' HL did.
enum class PointFriction { together, apart };
constexpr auto enum_names(PointFriction) {
    return std::array{"together", "apart"};
}

/// What fingers are in the world.
struct ProxySettings {
    ProxyKind kind = ProxyKind::rigid;  ///< of fingers that the scene gives none of their own
    PointFriction friction = PointFriction::together;  ///< point
    double sliding_friction = 1;  ///< point: dynamic friction, as a share of static friction
    /// Point: a body that is pressed harder yields, and is not felt again until the point has left
    /// it [N]. Unset: none does.
    std::optional<double> popthrough;
    bool changeable = false;  ///< the kind may change while a session runs: a window's wish

    template <class Visitor>
    void visit(Visitor& v) {
        v("kind", kind);
        v("friction", friction);
        v("sliding_friction", sliding_friction, Field::number().within(0, 1));
        v("popthrough", popthrough, Field::of(Quantity::force).positive());
        v("changeable", changeable);
    }

    ProxyKind of(const scene::Finger& finger) const { return finger.proxy.value_or(kind); }
};

enum class EnergyGuardMode { off, warn, act };
constexpr auto enum_names(EnergyGuardMode) {
    return std::array{"off", "warn", "act"};
}

/// What no force may exceed, whatever computed it, and what switches force off.
struct SafetySettings {
    std::optional<double> max_force;   ///< magnitude [N]; unset: the device's peak force
    double max_force_rate = 3000;      ///< change of force, magnitude [N/s]
    std::optional<double> max_torque;  ///< magnitude [N*m]; unset: the device's peak torque
    double max_torque_rate = 150;      ///< change of torque: of that force at 5 cm [N*m/s]
    double max_speed = 10;             ///< of a handle; a hand that throws reaches a few m/s [m/s]
    /// From one tick to the next, longer than any tick: so long a force may be held [s].
    double max_pause = 0.04;
    /// In which the device's motors warm, and cool: of the order of a small motor's winding [s].
    double heating_time = 10;
    double workspace_stiffness = 500;  ///< of the wall where a device's reach ends; 0: none [N/m]
    double soft_start = 0.5;           ///< in which force comes on, where there is one [s]
    std::string dead_man_finger;       ///< whose device has the dead-man switch; empty: none
    int dead_man_button = 0;           ///< which of its buttons
    EnergyGuardMode energy_guard = EnergyGuardMode::warn;

    /// Magnitude limit with a device of so much peak force, which is `scale` times what the hand
    /// gets of it [N].
    double largest_force(double peak, double scale = 1) const {
        return max_force ? std::min(*max_force * scale, peak) : peak;
    }
    /// The same of torque [N*m].
    double largest_torque(double peak) const { return std::min(max_torque.value_or(peak), peak); }

    template <class Visitor>
    void visit(Visitor& v) {
        v("max_force", max_force, Field::of(Quantity::force).positive());
        v("max_force_rate", max_force_rate, Field::of(Quantity::force_rate).positive());
        v("max_torque", max_torque, Field::of(Quantity::torque).positive());
        v("max_torque_rate", max_torque_rate, Field::of(Quantity::torque_rate).positive());
        v("max_speed", max_speed, Field::of(Quantity::speed).positive());
        v("max_pause", max_pause, Field::of(Quantity::time).within(0.02, 1));
        v("heating_time", heating_time, Field::of(Quantity::time).within(1, 1000));
        v("workspace_stiffness", workspace_stiffness,
          Field::of(Quantity::stiffness).within(0, 2000));
        v("soft_start", soft_start, Field::of(Quantity::time).within(0, 10));
        v("dead_man_finger", dead_man_finger);
        v("dead_man_button", dead_man_button, Field::number().within(0, 31));
        v("energy_guard", energy_guard);
    }
};

}  // namespace dihaptic::haptics
