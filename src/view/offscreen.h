// OpenGL drawing without a window or a display server, for pictures, videos and tests.
#pragma once

#include <memory>
#include <string>

#include "base/image.h"

namespace dihaptic::view {

/// An OpenGL 3.3 core context from Mesa, current in the thread that made it, and a framebuffer to
/// draw into. Mesa uses a graphics card if permitted, and otherwise draws in software.
class Offscreen {
  public:
    /// Throws Error, naming the package to install, when there is no OpenGL of this kind.
    Offscreen(int width, int height);
    ~Offscreen();
    Offscreen(const Offscreen&) = delete;
    Offscreen& operator=(const Offscreen&) = delete;

    int width() const { return width_; }
    int height() const { return height_; }
    /// OpenGL's name of the renderer.
    std::string renderer() const;
    /// Waits until everything is drawn.
    void wait() const;
    /// The picture in the framebuffer; waits until everything is drawn.
    Image read() const;

  private:
    struct Context;
    std::unique_ptr<Context> context_;
    int width_;
    int height_;
};

}  // namespace dihaptic::view
