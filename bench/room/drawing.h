// A view that draws as fast as possible in its own thread, as an additional load.
#pragma once

#include <atomic>
#include <exception>
#include <thread>

#include "base/latest.h"
#include "frame/frame.h"
#include "scene/scene.h"

namespace dihaptic::bench {

class Drawing {
  public:
    /// Draws `newest` until it is destroyed.
    Drawing(const scene::Scene& scene, Latest<frame::Frame>& newest);
    /// Passes on exceptions of drawing, e.g. Error without OpenGL.
    ~Drawing() noexcept(false);
    Drawing(const Drawing&) = delete;
    Drawing& operator=(const Drawing&) = delete;

    int64_t pictures() const { return pictures_; }

  private:
    void run(const scene::Scene& scene, Latest<frame::Frame>& newest);

    std::atomic<bool> stop_{false};
    std::atomic<int64_t> pictures_{0};
    std::exception_ptr failure_;
    std::thread thread_;
};

}  // namespace dihaptic::bench
