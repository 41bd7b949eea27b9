// Reads any text as YAML, the format of our configuration files, and reads the rewritten text.
#include "base/node.h"
#include "testing/fuzz.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
    using namespace dihaptic;
    try {
        const Node node = parse_yaml({reinterpret_cast<const char*>(data), size}, "any.yaml");
        (void)parse_yaml(to_yaml(node), "again.yaml");
    } catch (const Error&) {
        // reported with file, line and remedy, as intended
    }
    return 0;
}
