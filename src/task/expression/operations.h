// The arithmetic of expressions: the operators and functions.
#pragma once

#include <cmath>
#include <string_view>

#include "base/geometry.h"

namespace dihaptic::task {

inline double floor_remainder(const double* a) noexcept {
    const double r = std::fmod(a[0], a[1]);
    if (r == 0) return std::copysign(0.0, a[1]);
    return (r < 0) != (a[1] < 0) ? r + a[1] : r;
}
inline double sign_of(const double* a) noexcept {
    return static_cast<double>(a[0] > 0) - static_cast<double>(a[0] < 0);
}
inline double norm_of(const double* a) noexcept {
    return Vec3(a[0], a[1], a[2]).norm();
}

/// A function of an array of numbers, and the number of arguments it takes.
struct Operation {
    int arguments;
    double (*function)(const double* arguments) noexcept;
};
inline constexpr Operation kNegate{1, [](const double* a) noexcept { return -a[0]; }};
inline constexpr Operation kAdd{2, [](const double* a) noexcept { return a[0] + a[1]; }};
inline constexpr Operation kSubtract{2, [](const double* a) noexcept { return a[0] - a[1]; }};
inline constexpr Operation kMultiply{2, [](const double* a) noexcept { return a[0] * a[1]; }};
inline constexpr Operation kDivide{2, [](const double* a) noexcept { return a[0] / a[1]; }};
inline constexpr Operation kRemainder{2, floor_remainder};
inline constexpr Operation kPower{2, [](const double* a) noexcept { return std::pow(a[0], a[1]); }};
inline constexpr Operation kLess{2, [](const double* a) noexcept { return double(a[0] < a[1]); }};
inline constexpr Operation kAtMost{2,
                                   [](const double* a) noexcept { return double(a[0] <= a[1]); }};
inline constexpr Operation kMore{2, [](const double* a) noexcept { return double(a[0] > a[1]); }};
inline constexpr Operation kAtLeast{2,
                                    [](const double* a) noexcept { return double(a[0] >= a[1]); }};
inline constexpr Operation kEqual{2, [](const double* a) noexcept { return double(a[0] == a[1]); }};
inline constexpr Operation kUnequal{2,
                                    [](const double* a) noexcept { return double(a[0] != a[1]); }};
inline constexpr Operation kAnd{2, [](const double* a) noexcept { return a[0] * a[1]; }};
inline constexpr Operation kOr{2, [](const double* a) noexcept { return double(a[0] + a[1] > 0); }};
inline constexpr Operation kNot{1, [](const double* a) noexcept { return 1 - a[0]; }};
/// Returns the first argument if the second is true, otherwise the third.
inline constexpr Operation kSelect{
    3, [](const double* a) noexcept { return a[1] != 0 ? a[0] : a[2]; }};
inline constexpr Operation kMin{2,
                                [](const double* a) noexcept { return a[1] < a[0] ? a[1] : a[0]; }};
inline constexpr Operation kMax{2,
                                [](const double* a) noexcept { return a[1] > a[0] ? a[1] : a[0]; }};
inline constexpr Operation kSquareRoot{1, [](const double* a) noexcept { return std::sqrt(a[0]); }};
inline constexpr Operation kNorm{3, norm_of};

/// Rule for the dimensions of a function's arguments. With `same`, `root` and `any`, all arguments
/// must have the same dimension, and the result has that dimension, its square root, or none,
/// respectively. With `pure`, the arguments must be pure numbers.
enum class Takes { same, root, any, pure };

struct NamedFunction {
    std::string_view name;
    int least;  // minimum number of arguments
    int most;
    Takes takes;
    Operation operation;
};
inline constexpr NamedFunction kFunctions[] = {
    {"abs", 1, 1, Takes::same, {1, [](const double* a) noexcept { return std::abs(a[0]); }}},
    {"min", 2, 20, Takes::same, kMin},
    {"max", 2, 20, Takes::same, kMax},
    {"hypot",
     2,
     2,
     Takes::same,
     {2, [](const double* a) noexcept { return std::hypot(a[0], a[1]); }}},
    {"sqrt", 1, 1, Takes::root, kSquareRoot},
    {"sign", 1, 1, Takes::any, {1, sign_of}},
    {"atan2",
     2,
     2,
     Takes::any,
     {2, [](const double* a) noexcept { return std::atan2(a[0], a[1]); }}},
    {"exp", 1, 1, Takes::pure, {1, [](const double* a) noexcept { return std::exp(a[0]); }}},
    {"log", 1, 1, Takes::pure, {1, [](const double* a) noexcept { return std::log(a[0]); }}},
    {"sin", 1, 1, Takes::pure, {1, [](const double* a) noexcept { return std::sin(a[0]); }}},
    {"cos", 1, 1, Takes::pure, {1, [](const double* a) noexcept { return std::cos(a[0]); }}},
    {"tan", 1, 1, Takes::pure, {1, [](const double* a) noexcept { return std::tan(a[0]); }}},
    {"floor", 1, 1, Takes::pure, {1, [](const double* a) noexcept { return std::floor(a[0]); }}},
    {"ceil", 1, 1, Takes::pure, {1, [](const double* a) noexcept { return std::ceil(a[0]); }}},
    {"round", 1, 1, Takes::pure, {1, [](const double* a) noexcept { return std::round(a[0]); }}},
    {"clamp",
     3,
     3,
     Takes::same,
     {3,
      [](const double* a) noexcept {
          const double low = a[1] > a[0] ? a[1] : a[0];
          return a[2] < low ? a[2] : low;
      }}},
};

}  // namespace dihaptic::task
