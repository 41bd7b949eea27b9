// Lets tests cause failures in the fake liblsl.
#pragma once

#include <dlfcn.h>

#include <stdexcept>

#include "fake_lsl_library.h"

namespace dihaptic::outlets {

enum class FakeLslFails { nothing, describing, opening, every_push, codes_only };

/// Sets how all streams in this program fail from now on.
inline void fake_lsl_fails(FakeLslFails what) {
    void* const library = dlopen(DIHAPTIC_FAKE_LSL, RTLD_LAZY | RTLD_LOCAL);
    if (library == nullptr) throw std::runtime_error(dlerror());
    reinterpret_cast<void (*)(int)>(dlsym(library, "dihaptic_fake_lsl_fail"))(
        static_cast<int>(what));
}

}  // namespace dihaptic::outlets
