// Defines which text is valid. The program must be able to read the files that it has written, so
// the same rules apply to all text that is written to files or read from them.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace dihaptic {

/// Length of the UTF-8 character at the start of a text [bytes]; 0 if the bytes do not form a
/// character (Unicode 15, table 3-7: overlong forms and single surrogates are excluded).
size_t utf8_length(std::string_view text);

/// The reason why a text cannot be written to a file and read back.
struct TextFault {
    size_t at = 0;     ///< position of the first invalid byte
    std::string what;  ///< e.g. "has a control character (ESC)"
    std::string remedy;
};

/// Whether a text may have several lines or is a single line, such as a name, an answer or an
/// argument.
enum class Lines { several, one };

/// Finds the first invalid part of a text: bytes that are not UTF-8, a byte order mark or a
/// noncharacter, a control character (except tabs and line feeds in a text of several lines) or, in
/// a single line, a character that changes the order of the characters around it.
std::optional<TextFault> find_fault(std::string_view text, Lines lines = Lines::several);

/// Throws Error if find_fault() finds a fault. `name` is what the message calls the text.
void check_text(std::string_view text, const std::string& name, Lines lines = Lines::one);

/// Returns the text with each byte or character that find_fault() rejects replaced with U+FFFD.
/// Used for words from elsewhere, such as a device's name, and for words that older versions
/// recorded.
std::string mended(std::string_view text, Lines lines = Lines::several);

}  // namespace dihaptic
