// What a rig file says of an Inverse3.
#pragma once

#include <array>
#include <string>

#include "devices/device_group.h"

namespace dihaptic::devices::haply {

/// How the service spells the field of a force command: `vector` in the documents of 3.5, `values`
/// in those before it and in clients of that time.
enum class ForceKey { vector, values };
constexpr auto enum_names(ForceKey) {
    return std::array{"vector", "values"};
}

struct Options {
    std::string device_id;  ///< serial, hexadecimal, as the service lists it
    std::string url = "ws://localhost:10001/";
    ForceKey force_key = ForceKey::vector;
    double time_out = 0.02;           ///< without an answer for so long, the service is gone [s]
    double peak_force = 5;            ///< larger forces are clamped; not verified [N]
    std::string verse_grip;           ///< serial of a wired grip that gives the orientation
    std::string wireless_verse_grip;  ///< the same, of a wireless one

    template <class Visitor>
    void visit(Visitor& v) {
        v("device_id", device_id, Field::text().required());
        v("url", url);
        v("force_key", force_key);
        v("time_out", time_out, Field::of(Quantity::time).within(1e-3, 1));
        v("peak_force", peak_force, Field::of(Quantity::force).positive().at_most(20));
        v("verse_grip", verse_grip);
        v("wireless_verse_grip", wireless_verse_grip);
    }
};

/// A device's options; every problem goes to `diagnostics`.
Options read_options(const DeviceConfig& config, Diagnostics& diagnostics);

}  // namespace dihaptic::devices::haply
