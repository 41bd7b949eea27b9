// The parts of a rig whose options depend on their kind (base/kinds.h), i.e. devices and outlets.
#pragma once

#include "base/kinds.h"
#include "rig/rig.h"

namespace dihaptic::rig {

inline Kinds<Device> kinds_of(const Device& value) {
    Kinds<Device> out{"backend", {}};
    for (const devices::Backend& backend : devices::backends()) {
        if (backend.options == nullptr) continue;
        out.each.emplace_back(backend.name, value).second.backend = backend.name;
    }
    return out;
}

}  // namespace dihaptic::rig

namespace dihaptic::outlets {

inline Kinds<OutletConfig> kinds_of(const OutletConfig& value) {
    Kinds<OutletConfig> out{"kind", {}};
    for (const Kind& kind : kinds())
        out.each.emplace_back(kind.name, value).second.kind = kind.name;
    return out;
}

}  // namespace dihaptic::outlets
