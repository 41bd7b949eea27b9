// Describes where the tracking space of a headset is in the world, so that things are seen where
// the hand feels them.
#pragma once

#include <array>

#include "base/diagnostics.h"
#include "base/field.h"
#include "base/geometry.h"

namespace dihaptic::display {

/// OpenXR's reference spaces that are of use to a seated person.
enum class HeadsetSpace { stage, local };
constexpr auto enum_names(HeadsetSpace) {
    return std::array{"stage", "local"};
}

struct Headset {
    HeadsetSpace space = HeadsetSpace::stage;
    Vec3 position = Vec3::Zero();  ///< of the space's origin [m]
    Vec3 rotation = Vec3::Zero();  ///< about the world's axes x, then y, then z [rad]
    Place place{};

    /// X_WS of the space S, which has x right, y up and z backward.
    Pose X_WS() const {
        const Quat upright = rotation_xyz({std::numbers::pi / 2, 0, 0});
        return {rotation_xyz(rotation) * upright, position};
    }

    template <class Visitor>
    void visit(Visitor& v) {
        v("space", space,
          says("Space that the headset says where it is in: its stage, whose origin is on the "
               "floor and stays; or a local one, whose origin is where the head was at first."));
        v("position", position, Field::length().within(-100, 100).says("Where its origin is."));
        v("rotation", rotation,
          Field::of(Quantity::angle)
              .within(-100, 100)
              .says("Its rotation about the world's axes x, then y, then z; with none, its "
                    "forward is the world's +y."));
        if constexpr (requires { v.place(); }) place = v.place();
    }
};

}  // namespace dihaptic::display
