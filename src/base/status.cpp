#include "base/status.h"

namespace dihaptic {

std::string words(uint32_t status) {
    std::string out;
    for_each_status(status, [&](Status bit) {
        if (!out.empty()) out += "; ";
        out += describe(bit).what;
    });
    return out;
}

}  // namespace dihaptic
