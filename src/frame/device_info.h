// Describes a device's identity and capabilities, and the hand that holds it. A device backend
// reports this description, a session records it, and a replay uses it again; all three follow from
// visit().
#pragma once

#include <limits>
#include <optional>
#include <string>

#include "base/field.h"
#include "base/geometry.h"
#include "model/phantom_links.h"

namespace dihaptic::frame {

struct DeviceInfo {
    std::string model;
    std::string serial;  ///< serial number; "" if the device does not report one
    /// Whether the device is simulated, i.e. not held by a person's hand, so that a late force
    /// harms nobody.
    bool simulated = false;
    /// Peak force [N]; infinite if unknown, as for a real device that has not been opened yet.
    double peak_force = std::numeric_limits<double>::infinity();
    /// Force that the device can sustain [N].
    double continuous_force = std::numeric_limits<double>::infinity();
    std::optional<Vec3> workspace;  ///< edge lengths of the box around D's origin [m]
    bool measures_orientation = false;
    double peak_torque = 0;  ///< 0 if the device renders no torque [N*m]
    /// Torque that the device can sustain [N*m].
    double continuous_torque = std::numeric_limits<double>::infinity();
    /// Factor by which the readings are larger than the movement of the hand, and by which the
    /// forces listed here are larger than the forces at the hand.
    double scale = 1;
    double delay = 0;  ///< time from write() until the force acts [s]
    /// Largest stiffness [N/m] and damping [N*s/m] that the device renders stably, if the
    /// manufacturer states them. Settings that are given as fractions of a maximum refer to these
    /// values.
    std::optional<double> max_stiffness;
    std::optional<double> max_damping;
    /// Link lengths of a Premium that reports joint angles, from which p_DH is computed.
    std::optional<model::PhantomLinks> arm;

    // for handle and hand together; 0 if not known
    double damping = 0;       ///< damping, which limits the stable stiffness [N*s/m]
    double mass = 0;          ///< [kg]
    double turn_damping = 0;  ///< [N*m*s/rad]
    double inertia = 0;       ///< [kg*m^2]

    template <class Visitor>
    void visit(Visitor& v) {
        v("model", model);
        v("serial", serial);
        v("simulated", simulated);
        v("peak_force", peak_force, Field::of(Quantity::force).positive().at_most(1e6));
        v("continuous_force", continuous_force, Field::of(Quantity::force).positive().at_most(1e6));
        v("workspace", workspace, Field::length().positive().at_most(1e4));
        v("orientation", measures_orientation);
        v("peak_torque", peak_torque, Field::of(Quantity::torque).within(0, 1e4));
        v("continuous_torque", continuous_torque,
          Field::of(Quantity::torque).positive().at_most(1e4));
        v("scale", scale, Field::number().within(0.01, 100));
        v("delay", delay, Field::of(Quantity::time));
        v("max_stiffness", max_stiffness, Field::of(Quantity::stiffness));
        v("max_damping", max_damping, Field::of(Quantity::damping));
        v("arm", arm);
        v("damping", damping, Field::of(Quantity::damping).within(0, 1e4));
        v("mass", mass, Field::of(Quantity::mass));
        v("turn_damping", turn_damping, Field::of(Quantity::turn_damping));
        v("inertia", inertia, Field::of(Quantity::inertia));
    }

    /// Returns the same device in the units of a world in which the device's movement is `s` times
    /// the movement of the hand.
    DeviceInfo scaled(double s) const {
        DeviceInfo out = *this;
        out.scale *= s;
        out.peak_force *= s;
        out.continuous_force *= s;
        if (out.workspace) *out.workspace *= s;
        return out;
    }

    bool operator==(const DeviceInfo&) const = default;
};

}  // namespace dihaptic::frame
