// Describes the pose of a headset's tracking space in the world, so that objects can be shown where
// the hand feels them.
#pragma once

#include <array>

#include "base/diagnostics.h"
#include "base/field.h"
#include "base/geometry.h"

namespace dihaptic::display {

/// The OpenXR reference spaces that suit a seated person.
enum class HeadsetSpace { stage, local };
constexpr auto enum_names(HeadsetSpace) {
    return std::array{"stage", "local"};
}

struct Headset {
    HeadsetSpace space = HeadsetSpace::stage;
    Vec3 position = Vec3::Zero();  ///< position of the origin of the space [m]
    Vec3 rotation = Vec3::Zero();  ///< rotations about the world's x, then y, then z axis [rad]
    Place place{};

    /// Pose of the space S, in which x points right, y up and z backward.
    Pose X_WS() const {
        const Quat upright = rotation_xyz({std::numbers::pi / 2, 0, 0});
        return {rotation_xyz(rotation) * upright, position};
    }

    template <class Visitor>
    void visit(Visitor& v) {
        v("space", space,
          says("Reference space of the headset's poses: 'stage', whose origin is fixed on the "
               "floor, or 'local', whose origin is the head's initial position."));
        v("position", position, Field::length().within(-100, 100).says("Origin of this space."));
        v("rotation", rotation,
          Field::of(Quantity::angle)
              .within(-100, 100)
              .says("Rotation of this space about the world's axes x, then y, then z; if zero, its "
                    "forward direction is the world's +y."));
    }
};

}  // namespace dihaptic::display
