// Reads arbitrary text as an OBJ mesh that names a materials file, and also as that materials file.
#include "scene/materials.h"

#include <string_view>

#include "testing/fuzz.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
    using namespace dihaptic;
    const std::string file = testing::as_file({data, size}, "mesh.mtl");
    (void)scene::read_materials(file);
    (void)scene::materials_of(file, {reinterpret_cast<const char*>(data), size});
    return 0;
}
