#include "bench/bench_log.h"

#include <filesystem>

namespace dihaptic::bench {

BenchLog::BenchLog(const scene::Scene& scene, const frame::Settings& settings) {
    head_.tick = settings.tick();
    head_.fingers = scene::finger_names(scene);
    for (const scene::Body& body : scene.bodies) head_.bodies.push_back(body.name);
    for (const scene::Joint& joint : recorded_joints(scene)) head_.joints.push_back(joint.name);
}

recording::Recorder BenchLog::record(recording::Writing writing) const {
    std::filesystem::remove(file("raw.log"));
    return {file("raw.log"), head_, writing};
}

}  // namespace dihaptic::bench
