// Reads any file as a recorded movement and, if there are no errors, repairs it.
#include "hand/movement.h"

#include "hand/repair.h"
#include "testing/fuzz.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
    using namespace dihaptic;
    const std::string file = testing::as_file({data, size}, "movement.csv");
    for (const hand::RecordingAxes axes : {hand::RecordingAxes::world, hand::RecordingAxes::y_up}) {
        Diagnostics diagnostics;
        try {
            const hand::Movement movement = hand::read_movement(file, axes, diagnostics);
            if (!diagnostics.has_errors()) (void)hand::repair(movement);
        } catch (const Error&) {
            // errors are reported with file, line and remedy, as intended
        }
    }
    return 0;
}
