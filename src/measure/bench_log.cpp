#include "measure/bench_log.h"

#include <stdlib.h>

#include <filesystem>

namespace dihaptic::measure {

BenchLog::BenchLog(const scene::Scene& scene, const servo::Settings& settings) {
    std::string name = (std::filesystem::temp_directory_path() / "dihaptic-bench-XXXXXX").string();
    if (mkdtemp(name.data()) == nullptr)
        throw Error("no temporary folder can be made", "Free some space in /tmp.");
    folder_ = name;
    head_.tick = settings.tick();
    head_.fingers = scene::finger_names(scene);
    for (const scene::Body& body : scene.bodies) head_.bodies.push_back(body.name);
}

BenchLog::~BenchLog() {
    std::error_code ignored;
    std::filesystem::remove_all(folder_, ignored);
}

recording::Recorder BenchLog::record(recording::Writing writing) const {
    std::filesystem::remove(file("raw.log"));
    return {file("raw.log"), head_, writing};
}

}  // namespace dihaptic::measure
