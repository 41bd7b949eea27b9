// Reads arbitrary text as a rig file.
#include "rig/rig.h"

#include "testing/fuzz.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
    using namespace dihaptic;
    const std::string file = testing::as_file({data, size}, "rig.yaml");
    Diagnostics diagnostics;
    try {
        (void)rig::read_rig(file, diagnostics);
    } catch (const Error&) {
        // bad input is expected to cause an Error with file, line and remedy
    }
    return 0;
}
