// A number in a file, which may also be written as an expression: hold_s: wait, or position_mm: [0,
// 10 * step, 20]. The code that knows the names in the expression compiles the text
// (task/plan/formulas.h), and sets the value once the names have values.
#pragma once

#include <array>
#include <string>

#include "base/diagnostics.h"
#include "base/field.h"
#include "base/geometry.h"

namespace dihaptic {

struct Formula {
    double value = 0;  ///< the number, or the result of the text in the present trial, in SI units
    std::string text;  ///< the expression; empty for a plain number
    double to_si = 1;  ///< SI value of the key's unit, which applies if the text has no dimension
    std::string key;   ///< the key as written in the file
    Place place;
    Field field;     ///< bounds on the result of the expression
    int index = -1;  ///< index of the compiled text; -1 if there is none

    Formula() = default;
    Formula(double number) : value(number) {}  // NOLINT(google-explicit-constructor)

    bool computed() const { return !text.empty(); }
    bool operator==(const Formula& other) const {
        return text == other.text && (computed() || value == other.value);
    }
};

/// The components of a vector. If one component is an expression, all components have a text, so
/// that the vector can be written again in the unit in which it was given.
using FormulaVec3 = std::array<Formula, 3>;

inline Vec3 value(const FormulaVec3& v) noexcept {
    return {v[0].value, v[1].value, v[2].value};
}
inline FormulaVec3 as_formula(const Vec3& v) {
    return {v.x(), v.y(), v.z()};
}

}  // namespace dihaptic
