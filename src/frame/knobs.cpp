#include "frame/knobs.h"

#include <fmt/format.h>

#include <cmath>

namespace dihaptic::frame {

std::string words(const Knob& knob, double value) {
    if (std::isnan(value) && knob.unset != nullptr) return knob.unset;
    return fmt::format("{:g}", value);
}

}  // namespace dihaptic::frame
