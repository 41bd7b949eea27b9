// OpenGL drawing without a window or a display server, for pictures, videos and tests.
#pragma once

#include <memory>
#include <string>

#include "base/image.h"

namespace dihaptic::view {

/// A framebuffer to draw into, and an OpenGL 3.3 core context from Mesa, which is current in the
/// thread that made it. Mesa uses a graphics card if the user has permission, and otherwise draws
/// in software.
class Offscreen {
  public:
    /// Throws Error, which names the package to install, when such an OpenGL context is not
    /// available.
    Offscreen(int width, int height);
    ~Offscreen();
    Offscreen(const Offscreen&) = delete;
    Offscreen& operator=(const Offscreen&) = delete;

    int width() const { return width_; }
    int height() const { return height_; }
    /// Name of the renderer, as given by OpenGL.
    std::string renderer() const;
    /// Waits until all drawing has finished.
    void wait() const;
    /// Waits until all drawing has finished, and returns the picture in the framebuffer.
    Image read() const;

  private:
    struct Context;
    std::unique_ptr<Context> context_;
    int width_;
    int height_;
};

}  // namespace dihaptic::view
