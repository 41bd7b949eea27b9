// Reads any file as a scene.
#include "scene/scene.h"

#include "testing/fuzz.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
    using namespace dihaptic;
    const std::string file = testing::as_file({data, size}, "scene.yaml");
    Diagnostics diagnostics;
    try {
        (void)scene::read_scene(file, diagnostics);
    } catch (const Error&) {
        // reported with file, line and remedy, as it should be
    }
    return 0;
}
