// Reads an arbitrary file as a scene, and moves bodies in its text.
#include "scene/body_text.h"
#include "scene/scene.h"

#include "testing/fuzz.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
    using namespace dihaptic;
    const std::string file = testing::as_file({data, size}, "scene.yaml");
    Diagnostics diagnostics;
    const std::string text(reinterpret_cast<const char*>(data), size);
    try {
        for (const scene::Body& body : scene::read_scene(file, diagnostics).bodies)
            (void)scene::moved_body(text, body.name, {0.01, 0, -0.02}, 0.5);
    } catch (const Error&) {
        // the mistake is reported with file, line and remedy, as intended
    }
    return 0;
}
