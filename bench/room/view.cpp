#include "bench/view.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "bench/duration.h"
#include "view/offscreen.h"
#include "view/scene_view.h"

namespace dihaptic::bench {
namespace {

scene::Scene block_on_table() {
    scene::Scene scene;
    scene.bodies.resize(2);
    scene.bodies[0].name = "table";
    scene.bodies[0].shape = scene::Shape::box({0.6, 0.4, 0.05});
    scene.bodies[0].position = {0, 0, -0.025};
    scene.bodies[0].fixed = true;
    scene.bodies[1].name = "block";
    scene.bodies[1].shape = scene::Shape::box(Vec3::Constant(0.04));
    scene.bodies[1].mass = 0.1;
    Diagnostics diagnostics;
    scene::complete(scene, "", diagnostics);
    return scene;
}

frame::Frame frame_at(const scene::Scene& scene, int i) {
    frame::Frame frame;
    for (const scene::Body& body : scene.bodies) frame.bodies.push_back({body.pose()});
    const Vec3 p(0.03 * std::sin(0.1 * i), 0, 0.07 + 0.05 * std::sin(0.07 * i));
    frame.bodies[1].X_WB.p = p;
    frame.fingers.resize(2);
    frame.fingers[0].p_WP = p - Vec3(0.0225, 0, 0);
    frame.fingers[1].p_WP = p + Vec3(0.0225, 0, 0);
    return frame;
}

double median(std::vector<double> values) {
    std::nth_element(values.begin(), values.begin() + static_cast<long>(values.size() / 2),
                     values.end());
    return values[values.size() / 2];
}

}  // namespace

ViewFigures bench_view(int frames, const measure::Progress& progress) {
    const scene::Scene scene = block_on_table();
    const view::Camera camera = view::cameras(scene).front();
    ViewFigures out;
    for (const auto& size : {std::pair{640, 360}, {1280, 720}}) {
        // no structured binding: Clang 14 lets no lambda capture one
        const int width = size.first;
        const int height = size.second;
        const view::Offscreen offscreen(width, height);
        view::SceneView variance(scene, view::Shadows::variance);
        view::SceneView plain(scene, view::Shadows::plain);
        view::SceneView coarse(scene, view::Shadows::variance);
        coarse.set_detail(2.0 / 3);
        const std::array<view::SceneView*, 3> drawn{&variance, &plain, &coarse};
        std::array<std::vector<double>, 3> times;
        for (int i = 0; i < frames; ++i) {
            if (progress)
                progress(fmt::format("{}x{}", width, height),
                         0.5 * static_cast<double>(out.sizes.size()) + 0.5 * i / frames);
            for (size_t k = 0; k < drawn.size(); ++k) {
                const double took = duration_of([&] {
                    drawn[k]->draw(frame_at(scene, i), camera, width, height);
                    offscreen.wait();
                });
                // the first picture makes resources used by the others
                if (i > 0) times[k].push_back(1e3 * took);
            }
        }
        out.renderer = offscreen.renderer();
        out.sizes.push_back({width, height, median(times[0]), median(times[1]), median(times[2])});
    }
    return out;
}

}  // namespace dihaptic::bench
