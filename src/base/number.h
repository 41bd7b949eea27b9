// Numbers as text. The C library reads and writes numbers according to the system's language
// (LC_NUMERIC), which the window's toolkit activates: strtod() may then stop at the decimal point
// of 0.5 and return 0. All numbers are therefore converted by these functions, or written by fmt,
// which ignores the language unless told otherwise (test/numbers_test.py).
#pragma once

#include <charconv>
#include <concepts>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace dihaptic {

/// The number that the whole word represents, e.g. "+1e3"; nullopt if the word is not a number or
/// the number is not finite.
std::optional<double> finite_number(std::string_view word);

/// Like finite_number(), but also accepts "inf" and "-inf", which occur in tables.
std::optional<double> any_number(std::string_view word);

/// The whole number that a word of digits represents; nullopt if the word is not a whole number or
/// the number does not fit into the type.
template <std::integral Whole>
std::optional<Whole> whole_number(std::string_view word, int base = 10) {
    Whole value{};
    const char* const last = word.data() + word.size();
    const auto [end, status] = std::from_chars(word.data(), last, value, base);
    if (status != std::errc() || end != last) return std::nullopt;
    return value;
}

/// The shortest text that is read back as exactly the same number.
std::string number_text(double value);
/// The number as text, with the given number of significant digits.
std::string number_text(double value, int digits);
/// A whole number as text.
std::string number_text(std::integral auto value) {
    char digits[24];
    return {digits, std::to_chars(digits, digits + sizeof digits, value).ptr};
}

}  // namespace dihaptic
