#include "devices/device_group.h"

namespace dihaptic::devices {

const Backend* find_backend(const std::string& name) {
    for (const Backend& backend : backends()) {
        if (name == backend.name) return &backend;
    }
    return nullptr;
}

}  // namespace dihaptic::devices
