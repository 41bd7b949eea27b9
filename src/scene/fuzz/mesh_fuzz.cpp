// Reads any file as a mesh, in a format chosen by its first bytes; mainly tests the handling
// of answers from dihaptic-mesh.
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
        // reported with file, line and remedy, as intended
    }
    return 0;
}
