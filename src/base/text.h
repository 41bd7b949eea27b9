// Defines valid text. The program must be able to read again what it writes, so the same
// rule holds for all text that is written to files and read from them.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace dihaptic {

/// Length of the UTF-8 character that a text starts with [bytes]; 0 if the bytes are not a
/// character (Unicode 15, table 3-7: neither too long a form, nor half of a surrogate pair).
size_t utf8_length(std::string_view text);

/// A reason why words cannot be written to a file and read again.
struct TextFault {
    size_t at = 0;     ///< position of its first byte
    std::string what;  ///< e.g. "has a control character (ESC)"
    std::string remedy;
};

/// Whether a text may have several lines, or is a single one: a name, an answer, an argument.
enum class Lines { several, one };

/// The first thing that does not belong in a text: bytes that are not UTF-8, a byte order mark or a
/// noncharacter, a control character (except tabs and line feeds in a text of several lines) and,
/// in a single line, a character that changes the order of those around it.
std::optional<TextFault> find_fault(std::string_view text, Lines lines = Lines::several);

/// Throws Error if find_fault() finds a fault. `name`: the text's name in the message.
void check_text(std::string_view text, const std::string& name, Lines lines = Lines::one);

/// The text with U+FFFD in place of each byte or character that find_fault() finds. Used for words
/// from elsewhere, such as a device's name, and for those that older versions recorded.
std::string mended(std::string_view text, Lines lines = Lines::several);

}  // namespace dihaptic
