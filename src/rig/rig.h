// The rig: which devices there are, where they stand, and which finger each holds (docs/files.md).
#pragma once

#include "devices/device_group.h"
#include "outlets/outlet.h"

namespace dihaptic::rig {

struct Device {
    std::string finger;
    std::string backend;
    Vec3 position = Vec3::Zero();  ///< of D's origin in the world [m]
    Vec3 rotation = Vec3::Zero();  ///< about the world's axes x, then y, then z [rad]
    Node options;                  ///< the backend's own
    Place place;

    template <class Visitor>
    void visit(Visitor& v) {
        v("finger", finger, Field::text().required());
        v("backend", backend, Field::text().required());
        v("position", position, Field::length().within(-100, 100));
        v("rotation", rotation, Field::of(Quantity::angle));
        v("options", options);
        if constexpr (requires { v.place(); }) place = v.place();
    }

    Pose X_WD() const { return {rotation_xyz(rotation), position}; }
};

struct Rig {
    std::string title;
    std::vector<Device> devices;
    std::vector<outlets::OutletConfig> outlets;
    Node settings;  ///< settings that this rig asks for (servo::Settings)
    Place place;

    template <class Visitor>
    void visit(Visitor& v) {
        v("title", title);
        v("devices", devices, Field::text().required());
        v("outlets", outlets);
        v("settings", settings);
        if constexpr (requires { v.place(); }) place = v.place();
    }
};

/// Reads a rig file; every problem goes to `diagnostics`.
Rig read_rig(const std::string& file, Diagnostics& diagnostics);

/// Whether its devices are real: they keep real time, and move a person's hand.
bool is_real(const Rig& rig);

/// A rig without a file: an ideal simulated device for each finger.
Rig simulated_rig(const std::vector<std::string>& fingers, bool orientation = false);

/// The devices for the scene's fingers, in the fingers' order. Throws Error when a finger has none.
std::unique_ptr<devices::DeviceGroup> make_devices(const Rig& rig,
                                                   const std::vector<std::string>& fingers,
                                                   const devices::Context& context);
/// The device that a finger holds. Throws Error when it holds none.
const Device& device_of(const Rig& rig, const std::string& finger);
/// X_WD by finger.
std::vector<Pose> poses(const Rig& rig, const std::vector<std::string>& fingers);

}  // namespace dihaptic::rig
