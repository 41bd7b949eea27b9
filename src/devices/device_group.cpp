#include "devices/device_group.h"

namespace dihaptic::devices {

std::string in_words(const Error& error) {
    const Problem& first = error.problems().front();
    return first.what + ". " + first.remedy;
}

const Backend* find_backend(const std::string& name) {
    for (const Backend& backend : backends()) {
        if (name == backend.name) return &backend;
    }
    return nullptr;
}

}  // namespace dihaptic::devices
