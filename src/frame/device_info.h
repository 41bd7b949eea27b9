// Describes a device's identity and capabilities, and the hand that holds it. A backend reports
// them, a session records them, and the replay uses them again; all three follow from visit().
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
    std::string serial;  ///< "" if the device does not report one
    /// Whether no person's hand holds the device; if so, a late force harms nobody.
    bool simulated = false;
    /// Peak force; infinite if unknown, as for a real device that has not been opened yet
    /// [N].
    double peak_force = std::numeric_limits<double>::infinity();
    /// Force that the device can sustain [N].
    double continuous_force = std::numeric_limits<double>::infinity();
    std::optional<Vec3> workspace;  ///< edges of the box around D's origin [m]
    bool measures_orientation = false;
    double peak_torque = 0;  ///< 0: the device renders no torque [N*m]
    /// Torque that the device can sustain [N*m].
    double continuous_torque = std::numeric_limits<double>::infinity();
    /// Factor by which readings exceed the hand's movement, and by which the forces listed here
    /// exceed those in the hand.
    double scale = 1;
    double delay = 0;  ///< time from write() to force [s]
    /// Largest stiffness [N/m] and damping [N*s/m] that the device renders stably, if its
    /// manufacturer states them: settings given as fractions of a maximum refer to these.
    std::optional<double> max_stiffness;
    std::optional<double> max_damping;
    /// Links of a Premium that reports joint angles, from which p_DH follows.
    std::optional<model::PhantomLinks> arm;

    // of handle and hand together; 0: not known
    double damping = 0;       ///< limits the stable stiffness [N*s/m]
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

    /// The same device in the units of a world in which its movement is `s` times the hand's.
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
