// Options for an Inverse3 in a rig file.
#pragma once

#include <array>
#include <string>

#include "devices/device_group.h"

namespace dihaptic::devices::haply {

/// The name that the service uses for the field in a force command: `vector` in the documentation
/// of version 3.5, `values` in earlier documentation and in clients of that time.
enum class ForceKey { vector, values };
constexpr auto enum_names(ForceKey) {
    return std::array{"vector", "values"};
}

struct Options {
    std::string device_id;  ///< hexadecimal serial number, as listed by the service
    std::string url = "ws://localhost:10001/";
    ForceKey force_key = ForceKey::vector;
    double time_out = 0.02;  ///< after this time without an answer, the connection is closed [s]
    double peak_force = 5;   ///< larger forces are clamped; the value has not been verified [N]
    std::string verse_grip;  ///< serial number of a wired grip for the orientation
    std::string wireless_verse_grip;  ///< serial number of a wireless grip for the orientation

    template <class Visitor>
    void visit(Visitor& v) {
        v("device_id", device_id,
          Field::text().required().says(
              "Serial number, hexadecimal, as listed by Haply's service."));
        v("url", url, says("Address of the service, which is on this machine."));
        v("force_key", force_key,
          says(
              "The service's spelling of a force's field: 'vector' from 3.5 on, 'values' before."));
        v("time_out", time_out,
          Field::of(Quantity::time)
              .within(1e-3, 1)
              .says("Time without an answer after which the connection is closed."));
        v("peak_force", peak_force,
          Field::of(Quantity::force)
              .positive()
              .at_most(20)
              .says("Limit to which larger forces are reduced."));
        v("verse_grip", verse_grip,
          says("Serial number of a wired VerseGrip, which measures orientation."));
        v("wireless_verse_grip", wireless_verse_grip,
          says("Serial number of a wireless VerseGrip, which measures orientation."));
    }
};

/// Reads the options of a device, and adds any problems to `diagnostics`.
Options read_options(const DeviceConfig& config, Diagnostics& diagnostics);

}  // namespace dihaptic::devices::haply
