// Options for a simulated device in a rig file, and the presets of these options.
#pragma once

#include <array>
#include <limits>
#include <optional>
#include <string>

#include "base/field.h"
#include "base/geometry.h"
#include "model/phantom_arm.h"

namespace dihaptic::devices::simulated {

/// The device that is simulated. plant: a bare mass, as used by the benchmarks. premium_1_0:
/// SensAble PHANToM Premium 1.0, according to its data sheet. touch: 3D Systems Touch, which
/// measures orientation. sigma_7: Force Dimension sigma.7 without its gripper, which also renders
/// torque. The largest stiffness and damping of these three devices, and the force and torque of
/// the sigma.7, are taken from CHAI3D 3.3; the masses, inertias, friction and encoder resolutions
/// of the last two are estimates.
enum class Preset { plant, premium_1_0, touch, sigma_7 };
constexpr auto enum_names(Preset) {
    return std::array{"plant", "premium_1_0", "touch", "sigma_7"};
}
/// What messages, recordings and the window call the device.
constexpr const char* model_of(Preset preset) {
    constexpr std::array kModels{"simulated device", "simulated Premium 1.0", "simulated Touch",
                                 "simulated sigma.7"};
    static_assert(kModels.size() == enum_names(Preset{}).size());
    return kModels[static_cast<size_t>(preset)];
}

/// point: a single mass at the endpoint, equal along all axes. phantom: the links and joints of a
/// Premium.
enum class Mechanics { point, phantom };
constexpr auto enum_names(Mechanics) {
    return std::array{"point", "phantom"};
}

struct Options {
    std::string serial;             ///< serial number that the device reports
    Preset preset = Preset::plant;  ///< sets all other options, each of which may also be given
    double mass = 0.075;            ///< apparent mass at the endpoint [kg]
    double peak_force = 8.5;        ///< larger forces are clamped [N]
    std::optional<double> continuous_force;  ///< force that the motors can sustain [N]
    double position_step = 0;                ///< resolution at the endpoint; 0 if exact [m]
    double friction = 0;                     ///< Coulomb friction at the endpoint [N]
    int delay_ticks = 0;                     ///< number of ticks until a written force acts
    int velocity_window = 8;  ///< number of ticks for the velocity if positions are rounded
    int buttons = 0;          ///< the buttons that the simulated hand holds down, one bit each
    std::optional<Vec3> workspace;  ///< edge lengths of the reachable box around D's origin [m]
    std::optional<double>
        max_stiffness;  ///< largest stable stiffness according to the manufacturer [N/m]
    std::optional<double>
        max_damping;  ///< largest stable damping according to the manufacturer [N*s/m]

    Mechanics arm = Mechanics::point;
    model::PhantomLinks links;  ///< phantom: link lengths; not verified for the 1.0 [m]
    /// For phantom: true minus reported joint angles, e.g. after a reset away from the standard
    /// configuration [rad].
    Vec3 joint_offset = Vec3::Zero();
    Vec3 misplaced_by = Vec3::Zero();  ///< displacement of D from its position in the rig, in D [m]
    Vec3 misplaced_turn = Vec3::Zero();  ///< rotation of D about its x, then y, then z axis [rad]

    bool orientation =
        false;  ///< whether orientation is measured; if not, the endpoint does not rotate
    double peak_torque = 0;  ///< larger torques are clamped; 0 if the device has none [N*m]
    std::optional<double> continuous_torque;  ///< torque that the motors can sustain [N*m]
    /// Moment of inertia of the handle about its endpoint, equal about all axes [kg*m^2].
    double inertia = 1e-4;
    double angle_step = 0;  ///< resolution of the gimbal's three encoders; 0 if exact [rad]

    template <class Visitor>
    void visit(Visitor& v) {
        v("serial", serial, says("Serial number reported by the device."));
        v("preset", preset,
          says("Simulated device; it sets all other options, whose defaults are those of "
               "plant."));
        if constexpr (requires { v.diagnostics(); }) {
            const std::string given = serial;
            *this = of(preset);
            serial = given;
        }
        v("mass", mass,
          Field::of(Quantity::mass).within(1e-3, 100).says("Apparent mass at the endpoint."));
        v("peak_force", peak_force,
          Field::of(Quantity::force)
              .within(0.01, 1e4)
              .says("Limit to which larger forces are reduced."));
        v("continuous_force", continuous_force,
          Field::of(Quantity::force).within(0.01, 1e4).says("Force that the motors can sustain."));
        visit_reading(v);
        v("workspace", workspace,
          Field::length().within(1e-3, 100).says(
              "Edges of the reachable box around the device's origin."));
        v("max_stiffness", max_stiffness,
          Field::of(Quantity::stiffness)
              .within(1, 1e6)
              .says("Largest stiffness that the device renders stably, according to its "
                    "manufacturer."));
        v("max_damping", max_damping,
          Field::of(Quantity::damping)
              .within(1e-3, 1e4)
              .says("Largest damping that the device renders stably, according to its "
                    "manufacturer."));
        visit_arm(v);
        visit_turning(v);
    }

    /// Pose of the true D relative to the D of the rig file.
    Pose misplaced() const { return {rotation_xyz(misplaced_turn), misplaced_by}; }

    static constexpr int kMostWindow = 64;
    static Options of(Preset preset);

  private:
    template <class Visitor>
    void visit_reading(Visitor& v) {
        v("position_step", position_step,
          Field::length().within(0, 0.01).says("Step of the encoders, at the endpoint; 0: exact."));
        v("friction", friction,
          Field::of(Quantity::force).within(0, 100).says("Coulomb friction at the endpoint."));
        v("delay_ticks", delay_ticks,
          Field::number().at_least(0).at_most(100).says(
              "Number of ticks between writing a force and its effect."));
        v("velocity_window", velocity_window,
          Field::number()
              .at_least(1)
              .at_most(kMostWindow)
              .says("Number of ticks for computing velocity, if positions have steps."));
        v("buttons", buttons,
          Field::number()
              .within(0, 0x7fffffff)
              .says("Buttons held down by the simulated hand, one bit each."));
    }
    template <class Visitor>
    void visit_arm(Visitor& v) {
        v("arm", arm,
          says("One mass at the endpoint, equal along all axes, or the links and joints of a "
               "Premium."));
        links.visit(v);
        v("joint_offset", joint_offset,
          Field::of(Quantity::angle)
              .within(-0.2, 0.2)
              .says("True minus reported joint angles, e.g. after a bad reset."));
        v("misplaced_by", misplaced_by,
          Field::length().within(-0.1, 0.1).says(
              "Displacement of the device from its position in the rig file, along its own axes."));
        v("misplaced_turn", misplaced_turn,
          Field::of(Quantity::angle)
              .within(-0.5, 0.5)
              .says("Rotation of the device from its orientation in the rig file, about its x, "
                    "then y, then z."));
    }
    template <class Visitor>
    void visit_turning(Visitor& v) {
        v("orientation", orientation,
          says("Whether the device measures orientation; otherwise the endpoint does not turn."));
        v("peak_torque", peak_torque,
          Field::of(Quantity::torque)
              .within(0, 100)
              .says("Limit to which larger torques are reduced; 0: no torque is rendered."));
        v("continuous_torque", continuous_torque,
          Field::of(Quantity::torque)
              .within(1e-4, 100)
              .says("Torque that the motors can sustain."));
        v("inertia", inertia,
          Field::of(Quantity::inertia)
              .within(1e-7, 1)
              .says("Moment of inertia of the handle about its endpoint, equal about all axes."));
        v("angle_step", angle_step,
          Field::of(Quantity::angle)
              .within(0, 0.1)
              .says("Step of the encoders for the handle's rotation; 0: exact."));
    }
};

}  // namespace dihaptic::devices::simulated
