#include "base/number.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>

namespace dihaptic {

std::optional<double> finite_number(std::string_view word) {
    if (word.starts_with('+')) {
        word.remove_prefix(1);
        if (word.starts_with('-')) return std::nullopt;
    }
    double value = 0;
    const char* const last = word.data() + word.size();
    const auto [end, status] = std::from_chars(word.data(), last, value);
    if (status != std::errc() || end != last || !std::isfinite(value)) return std::nullopt;
    return value;
}

std::optional<double> any_number(std::string_view word) {
    constexpr double kInfinite = std::numeric_limits<double>::infinity();
    if (word == "inf") return kInfinite;
    if (word == "-inf") return -kInfinite;
    return finite_number(word);
}

std::string number_text(double value) {
    return fmt::format("{}", value);
}

std::string number_text(double value, int digits) {
    return fmt::format("{:.{}g}", value, digits);
}

}  // namespace dihaptic
