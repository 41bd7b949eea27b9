// Numbers as text. The C library reads and writes them as the system's language does (LC_NUMERIC),
// which the window's toolkit puts in force: there strtod() ends at the point of 0.5, and says 0.
// So all numbers go through here, or are written by fmt, which knows no language unless it is told
// (test/numbers_test.py).
#pragma once

#include <charconv>
#include <concepts>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace dihaptic {

/// The number that a word says as a whole, "+1e3" too; nullopt if it says no number, or one that is
/// not finite.
std::optional<double> finite_number(std::string_view word);

/// As finite_number(), but "inf" and "-inf", as tables have them, are numbers too.
std::optional<double> any_number(std::string_view word);

/// The whole number that a word says in digits; nullopt if it says none, or one that does not fit.
template <std::integral Whole>
std::optional<Whole> whole_number(std::string_view word, int base = 10) {
    Whole value{};
    const char* const last = word.data() + word.size();
    const auto [end, status] = std::from_chars(word.data(), last, value, base);
    if (status != std::errc() || end != last) return std::nullopt;
    return value;
}

/// The shortest text that reads back as the same number.
std::string number_text(double value);
/// The number with so many significant digits.
std::string number_text(double value, int digits);
/// A whole number in digits.
std::string number_text(std::integral auto value) {
    char digits[24];
    return {digits, std::to_chars(digits, digits + sizeof digits, value).ptr};
}

}  // namespace dihaptic
