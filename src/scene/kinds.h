// The parts of a scene whose keys depend on their kind (base/kinds.h).
#pragma once

#include "base/kinds.h"
#include "scene/scene.h"

namespace dihaptic::scene {

template <class Struct>
requires requires(Struct& s) {
    s.shape.kind = ShapeKind::box;
}
Kinds<Struct> kinds_of(const Struct& value) {
    return each_kind<ShapeKind>("shape", value,
                                [](Struct& s, ShapeKind kind) { s.shape.kind = kind; });
}

inline Kinds<Joint> kinds_of(const Joint& value) {
    return each_kind<JointKind>("kind", value, [](Joint& j, JointKind kind) { j.kind = kind; });
}

}  // namespace dihaptic::scene
