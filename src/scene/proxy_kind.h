// How a finger is represented in the world.
#pragma once

#include <array>

namespace dihaptic::scene {

/// Kind of a finger's proxy: a rigid body with the shape of the finger, or a point that is kept on
/// surfaces.
enum class ProxyKind { rigid, point };
constexpr auto enum_names(ProxyKind) {
    return std::array{"rigid", "point"};
}

}  // namespace dihaptic::scene
