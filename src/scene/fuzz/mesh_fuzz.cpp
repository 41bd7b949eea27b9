// Reads an arbitrary file as a mesh, in a format that is chosen by its first bytes. This mainly
// tests how answers from dihaptic-mesh are handled.
#include "scene/mesh.h"

#include <string_view>

#include "testing/fuzz.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
    using namespace dihaptic;
    const std::string_view text(reinterpret_cast<const char*>(data), size);
    const std::string ending = text.starts_with("ply")     ? "ply"
                               : text.starts_with("solid") ? "stl"
                                                           : "obj";
    try {
        (void)scene::read_mesh(testing::as_file({data, size}, "mesh." + ending), 1e-3, {});
    } catch (const Error&) {
        // the fault is reported with file, line and remedy, as intended
    }
    return 0;
}
