// Factors that make up an effect: how they scale with its share, and how they are formatted for
// reports.
#pragma once

#include <string>
#include <vector>

#include "base/formula.h"

namespace dihaptic::task {

inline const FormulaVec3 kNoFactors{1, 1, 1};

/// The effective factor at a given share.
inline double part_of(double share, double factor) noexcept {
    return 1 + share * (factor - 1);
}
inline Vec3 part_of(double share, const Vec3& factors) noexcept {
    return Vec3::Ones() + share * (factors - Vec3::Ones());
}

/// The number in the given unit, or the text of its formula.
std::string in_words(const Formula& number, double unit = 1);
std::string in_words(const FormulaVec3& v, double unit = 1);
/// Appends "2 times the WHAT" or, for a formula, "WHAT times (FORMULA)" to `out` unless the factor
/// is 1.
void say_factor(const std::string& what, const Formula& factor, std::vector<std::string>& out);

}  // namespace dihaptic::task
