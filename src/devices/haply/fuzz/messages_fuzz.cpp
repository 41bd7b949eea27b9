// Reads arbitrary text as a message from the Inverse Service.
#include "devices/haply/messages.h"

#include <algorithm>
#include <vector>

#include "devices/haply/connection.h"
#include "testing/fuzz.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
    using namespace dihaptic::devices::haply;
    static StateReader reader(Connection::kMostBytes);
    static StateMessage message;
    if (size > Connection::kMostBytes) return 0;
    std::vector<char> text(size + Connection::kPadding);
    std::copy_n(data, size, text.begin());
    if (!reader.read({text.data(), size}, message)) return 0;
    // the sum covers every character to which the message points, because all of them must be
    // readable
    unsigned sum = 0;
    const auto look_at = [&](std::string_view letters) {
        for (const char letter : letters) sum += static_cast<unsigned char>(letter);
    };
    look_at(message.error);
    for (const DeviceState& device : message.devices()) {
        (void)message.device(device.id);
        look_at(device.id);
    }
    for (const GripState& grip : message.grips()) {
        (void)message.grip(grip.kind, grip.id);
        look_at(grip.id);
    }
    [[maybe_unused]] static volatile unsigned kept;
    kept = sum;
    return 0;
}
