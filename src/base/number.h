// Numbers as text. The C library reads and writes numbers according to the system's language
// (LC_NUMERIC), which the window's toolkit activates: strtod() may then stop at the point of 0.5
// and return 0. All numbers therefore go through these functions, or are written by fmt, which
// ignores the language unless asked (test/numbers_test.py).
#pragma once

#include <charconv>
#include <concepts>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace dihaptic {

/// The number that the whole word represents, e.g. "+1e3"; nullopt if it is not a number, or not
/// finite.
std::optional<double> finite_number(std::string_view word);

/// Like finite_number(), but also accepts "inf" and "-inf", which occur in tables.
std::optional<double> any_number(std::string_view word);

/// The whole number that a word of digits represents; nullopt if it is not a whole number or does
/// not fit.
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
/// The number with the given number of significant digits.
std::string number_text(double value, int digits);
/// A whole number in digits.
std::string number_text(std::integral auto value) {
    char digits[24];
    return {digits, std::to_chars(digits, digits + sizeof digits, value).ptr};
}

}  // namespace dihaptic
