// OpenGL without a window or a display server: for pictures, videos and tests.
#pragma once

#include <memory>
#include <string>

#include "view/image.h"

namespace dihaptic::view {

/// An OpenGL 3.3 core context, current in the thread that made it, and a framebuffer to draw into:
/// of Mesa, by a graphics card where it may use one, in software elsewhere.
class Offscreen {
  public:
    /// Throws Error, with the package to install, when there is no such OpenGL.
    Offscreen(int width, int height);
    ~Offscreen();
    Offscreen(const Offscreen&) = delete;
    Offscreen& operator=(const Offscreen&) = delete;

    int width() const { return width_; }
    int height() const { return height_; }
    /// What draws, in OpenGL's words.
    std::string renderer() const;
    /// Until all is drawn.
    void wait() const;
    /// What was drawn into the framebuffer; waits for it.
    Image read() const;

  private:
    struct Context;
    std::unique_ptr<Context> context_;
    int width_;
    int height_;
};

}  // namespace dihaptic::view
