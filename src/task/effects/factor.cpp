#include "task/effects/factor.h"

#include <fmt/format.h>

namespace dihaptic::task {

std::string in_words(const Formula& number, double unit) {
    return number.computed() ? number.text : fmt::format("{:.6g}", number.value / unit);
}

std::string in_words(const FormulaVec3& v, double unit) {
    return fmt::format("({}, {}, {})", in_words(v[0], unit), in_words(v[1], unit),
                       in_words(v[2], unit));
}

void say_factor(const std::string& what, const Formula& factor, std::vector<std::string>& out) {
    if (factor == 1) return;
    out.push_back(factor.computed() ? fmt::format("{} times ({})", what, in_words(factor))
                                    : fmt::format("{} times the {}", in_words(factor), what));
}

}  // namespace dihaptic::task
