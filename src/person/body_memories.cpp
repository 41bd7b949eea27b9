#include "person/body_memories.h"

#include <cmath>

namespace dihaptic::person {

void BodyMemories::restart(const std::vector<Learned::OfBody>& before) noexcept {
    constexpr double kAlike = 1e-9;  // [N]
    for (Body& body : bodies_) {
        body.known = body.looks;
        for (const Learned::OfBody& known : before) {
            if (known.body == body.name && std::abs(known.looks - body.looks.weight) < kAlike)
                body.known = known.memory;
        }
    }
}

std::vector<Learned::OfBody> BodyMemories::overnight() const {
    std::vector<Learned::OfBody> out;
    for (const Body& body : bodies_) out.push_back({body.name, body.looks.weight, body.known});
    return out;
}

}  // namespace dihaptic::person
