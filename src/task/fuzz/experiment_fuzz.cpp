// Passes the fuzzer's input to the reader of experiment files.
#include "task/file/experiment.h"

#include "testing/fuzz.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
    using namespace dihaptic;
    const std::string file = testing::as_file({data, size}, "experiment.yaml");
    Diagnostics diagnostics;
    try {
        (void)task::read_experiment(file, diagnostics);
    } catch (const Error&) {
        // throwing an Error with file, line and remedy is the correct response
    }
    return 0;
}
