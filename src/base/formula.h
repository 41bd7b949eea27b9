// A number of a file that may be written as an expression: hold_s: wait, or position_mm: [0, 10 *
// step, 20]. Whoever knows the expression's names compiles the text (task/numbers.h), and resolves
// it into a plain number when these have values.
#pragma once

#include <array>
#include <span>
#include <string>

#include "base/diagnostics.h"
#include "base/field.h"

namespace dihaptic {

struct Formula {
    double value = 0;  ///< of a number, in SI units
    std::string text;  ///< empty: the value stands
    double to_si = 1;  ///< unit of the key, in which a text without a dimension is read
    std::string key;   ///< as in the file
    Place place;
    Field field;     ///< bounds of what the text gives
    int index = -1;  ///< of the compiled text; -1: none

    Formula() = default;
    Formula(double number) : value(number) {}  // NOLINT(google-explicit-constructor)

    bool computed() const { return !text.empty(); }
    bool operator==(const Formula& other) const {
        return text == other.text && (computed() || value == other.value);
    }
};

/// The components of a vector. If one of them is computed, all have a text, so that the vector can
/// be written again in the unit that it was given in.
using FormulaVec3 = std::array<Formula, 3>;

/// A Formula for use in the tick.
struct Number {
    double value = 0;
    int index = -1;

    Number() = default;
    Number(const Formula& f)  // NOLINT(google-explicit-constructor)
        : value(f.value), index(f.index) {}
    /// `resolved`: what the compiled texts give, by index.
    double in(std::span<const double> resolved) const noexcept {
        const auto i = static_cast<size_t>(index);
        return i < resolved.size() ? resolved[i] : value;
    }
};

inline std::array<Number, 3> numbers(const FormulaVec3& v) {
    return {v[0], v[1], v[2]};
}

}  // namespace dihaptic
