// OpenXR with what it needs to know of OpenGL and X11, whose macros are taken back: their names are
// ordinary words.
#pragma once

#include <Eigen/Dense>
#include <ctime>

// these first: OpenXR's header does not include them
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

/// A structure of OpenXR of its type, all else zero.
template <class Struct>
Struct made(XrStructureType type) {
    Struct out{};
    out.type = type;
    return out;
}

}  // namespace dihaptic::headset::xr
