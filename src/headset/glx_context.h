// An OpenGL context on X11 without a window, for a thread that draws for a headset: OpenXR runtimes
// on Linux accept pictures from such a context.
#pragma once

#include <memory>

#include "headset/xr_platform.h"

namespace dihaptic::headset {

/// An OpenGL 3.3 core context, current in the thread that made it, with its own connection to X11.
class GlxContext {
  public:
    /// Throws Error when there is no X11, or no OpenGL 3.3.
    GlxContext();
    ~GlxContext();
    GlxContext(const GlxContext&) = delete;
    GlxContext& operator=(const GlxContext&) = delete;

    XrGraphicsBindingOpenGLXlibKHR binding() const;

  private:
    struct Close {
        void operator()(Display* display) const { XCloseDisplay(display); }
    };
    std::unique_ptr<Display, Close> display_;  // closed too if the rest cannot be made
    GLXFBConfig config_ = nullptr;
    GLXContext context_ = nullptr;
    GLXPbuffer surface_ = 0;
};

}  // namespace dihaptic::headset
