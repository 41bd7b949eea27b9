// Makes tests draw in software on every machine, because the stored pictures with which they
// compare were drawn by Mesa's software renderer.
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
