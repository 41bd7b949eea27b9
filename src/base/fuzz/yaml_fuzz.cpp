// Reads arbitrary text as YAML, the format of Dihaptic's configuration files, writes the result,
// and reads that again.
#include "base/node.h"
#include "testing/fuzz.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
    using namespace dihaptic;
    try {
        const Node node = parse_yaml({reinterpret_cast<const char*>(data), size}, "any.yaml");
        (void)parse_yaml(to_yaml(node), "again.yaml");
    } catch (const Error&) {
        // the mistake is reported with file, line and remedy, as intended
    }
    return 0;
}
