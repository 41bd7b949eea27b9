// Includes OpenXR and the OpenGL and X11 headers that it needs. Macros from these headers are
// undefined again, because their names are ordinary words.
#pragma once

#include <Eigen/Dense>
#include <ctime>

// included first, because OpenXR's header needs these headers but does not include them
#include <epoxy/gl.h>
#include <epoxy/glx.h>

#define XR_USE_PLATFORM_XLIB
#define XR_USE_GRAPHICS_API_OPENGL
#define XR_USE_TIMESPEC
#include <openxr/openxr.h>
#include <openxr/openxr_platform.h>

#undef None
#undef Success
#undef Status
#undef Bool
#undef True
#undef False
#undef Always

namespace dihaptic::headset::xr {

/// Returns an OpenXR structure with its type set and everything else zero.
template <class Struct>
Struct made(XrStructureType type) {
    Struct out{};
    out.type = type;
    return out;
}

}  // namespace dihaptic::headset::xr
