#include "bench/drawing.h"

#include "view/offscreen.h"
#include "view/scene_view.h"

namespace dihaptic::bench {

Drawing::Drawing(const scene::Scene& scene, Latest<frame::Frame>& newest)
    : thread_([this, &scene, &newest] {
          try {
              run(scene, newest);
          } catch (...) {
              failure_ = std::current_exception();
          }
      }) {}

Drawing::~Drawing() noexcept(false) {
    stop_ = true;
    thread_.join();
    if (failure_) std::rethrow_exception(failure_);
}

void Drawing::run(const scene::Scene& scene, Latest<frame::Frame>& newest) {
    const view::Offscreen picture(1280, 720);
    view::SceneView view(scene);
    const view::Camera camera = view::cameras(scene).front();
    while (!stop_) {
        view.draw(newest.read(), camera, picture.width(), picture.height());
        picture.wait();
        ++pictures_;
    }
}

}  // namespace dihaptic::bench
