// Pictures of tests are drawn in software, on whatever machine: those that are compared with stored
// ones are of Mesa's renderer.
#pragma once

#include <gtest/gtest.h>
#include <stdlib.h>

#include "view/offscreen.h"

namespace dihaptic::view {

inline Offscreen software_offscreen(int width, int height) {
    setenv("LIBGL_ALWAYS_SOFTWARE", "1", 1);
    return {width, height};
}

}  // namespace dihaptic::view
