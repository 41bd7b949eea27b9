// The representation of a finger in the world.
#pragma once

#include <array>

namespace dihaptic::scene {

/// Kind of a finger's proxy: a rigid body of the finger's shape, or a point kept on surfaces.
enum class ProxyKind { rigid, point };
constexpr auto enum_names(ProxyKind) {
    return std::array{"rigid", "point"};
}

}  // namespace dihaptic::scene
