// Lists a scene's hinges in the form that other simulators need: by body numbers, each body on
// its parent.
#pragma once

#include <optional>
#include <vector>

#include "scene/scene.h"

namespace dihaptic::bench {

/// A hinge that carries one body, at the start.
struct Hinge {
    size_t body = 0;
    std::optional<size_t> parent;  ///< or the world
    Vec3 p_W = Vec3::Zero();       ///< [m]
    Vec3 axis_W = Vec3::UnitZ();
};

/// The hinges of a scene without other joints, with parents before their children. Throws Error
/// for any feature that is not passed to peers: other joints, loops, and springs, dampers, friction
/// or stops.
std::vector<Hinge> hinges_of(const scene::Scene& scene);

/// The pose of a hinge at the start, its axis along z.
Pose frame_of(const Hinge& hinge);

}  // namespace dihaptic::bench
