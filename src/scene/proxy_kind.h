// What stands for a finger in the world.
#pragma once

#include <array>

namespace dihaptic::scene {

/// What a finger's proxy is: a rigid body of the finger's shape, or a point kept on surfaces.
enum class ProxyKind { rigid, point };
constexpr auto enum_names(ProxyKind) {
    return std::array{"rigid", "point"};
}

}  // namespace dihaptic::scene
