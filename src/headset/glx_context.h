// An OpenGL context on X11 without a window, for a thread that draws for a headset. OpenXR runtimes
// on Linux accept pictures from such a context.
#pragma once

#include <memory>

#include "headset/xr_platform.h"

namespace dihaptic::headset {

/// An OpenGL 3.3 core context with its own connection to X11. It is current in the thread that
/// created it.
class GlxContext {
  public:
    /// Creates the context. Throws Error if X11 or OpenGL 3.3 is not available.
    GlxContext();
    ~GlxContext();
    GlxContext(const GlxContext&) = delete;
    GlxContext& operator=(const GlxContext&) = delete;

    XrGraphicsBindingOpenGLXlibKHR binding() const;

  private:
    struct Close {
        void operator()(Display* display) const { XCloseDisplay(display); }
    };
    std::unique_ptr<Display, Close> display_;  // also closed if the rest cannot be created
    GLXFBConfig config_ = nullptr;
    GLXContext context_ = nullptr;
    GLXPbuffer surface_ = 0;
};

}  // namespace dihaptic::headset
