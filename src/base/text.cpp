#include "base/text.h"

#include <fmt/format.h>

#include <array>

#include "base/diagnostics.h"

namespace dihaptic {
namespace {

constexpr std::string_view kReplacement = "\xef\xbf\xbd";  // U+FFFD

unsigned char byte_of(std::string_view text, size_t i) {
    return static_cast<unsigned char>(text[i]);
}

/// Length of the character that starts with this byte; 0 if no character starts with it.
size_t length_by(unsigned char first) {
    if (first < 0x80) return 1;
    if (first < 0xc2 || first > 0xf4) return 0;
    return first < 0xe0 ? 2 : first < 0xf0 ? 3 : 4;
}

/// Whether the second byte of a character is outside the range that the first byte allows.
bool is_out_of_range(unsigned char first, unsigned char second) {
    return (first == 0xe0 && second < 0xa0) || (first == 0xed && second > 0x9f) ||
           (first == 0xf0 && second < 0x90) || (first == 0xf4 && second > 0x8f);
}

/// The code of a control character (C0, DEL, C1), or -1 if it is another character.
int control(std::string_view character) {
    const unsigned char first = byte_of(character, 0);
    if (character.size() == 1 && (first < 0x20 || first == 0x7f)) return first;
    if (character.size() == 2 && first == 0xc2 && byte_of(character, 1) < 0xa0)
        return byte_of(character, 1);
    return -1;
}

/// Whether YAML readers drop or refuse this character: a byte order mark or one of the two
/// noncharacters.
bool is_mark(std::string_view character) {
    return character == "\xef\xbb\xbf" || character == "\xef\xbf\xbe" ||
           character == "\xef\xbf\xbf";
}

/// Whether a character shifts the text after it on the screen, or moves that text to another line.
/// In a single line, such as a name or a command, the character could disguise the text (Unicode
/// Technical Report 36, 2.10).
bool is_reordering(std::string_view character) {
    if (character.size() != 3 || !character.starts_with("\xe2")) return false;
    const unsigned char second = byte_of(character, 1);
    const unsigned char third = byte_of(character, 2);
    return (second == 0x80 && third >= 0xa8 && third <= 0xae) ||  // U+2028 to U+202E
           (second == 0x81 && third >= 0xa6 && third <= 0xa9);    // U+2066 to U+2069
}

std::string name_of(int control) {
    constexpr std::array kNames{"NUL", "SOH", "STX", "ETX",       "EOT", "ENQ", "ACK",
                                "BEL", "BS",  "tab", "line feed", "VT",  "FF",  "carriage return"};
    if (control < static_cast<int>(kNames.size())) return kNames[static_cast<size_t>(control)];
    if (control == 0x1b) return "ESC, which arrow keys also send";
    return control == 0x7f ? "DEL" : fmt::format("U+{:04X}", control);
}

}  // namespace

size_t utf8_length(std::string_view text) {
    if (text.empty()) return 0;
    const size_t length = length_by(byte_of(text, 0));
    if (length < 2) return length;
    if (length > text.size() || is_out_of_range(byte_of(text, 0), byte_of(text, 1))) return 0;
    for (size_t i = 1; i < length; ++i) {
        if ((byte_of(text, i) & 0xc0) != 0x80) return 0;
    }
    return length;
}

std::optional<TextFault> find_fault(std::string_view text, Lines lines) {
    size_t length = 0;
    for (size_t i = 0; i < text.size(); i += length) {
        length = utf8_length(text.substr(i));
        if (length == 0) {
            return TextFault{
                i, fmt::format("is not UTF-8 text: byte {} is {:#04x}", i + 1, byte_of(text, i)),
                "Type it in a terminal that is set to UTF-8, or rename the file."};
        }
        const std::string_view character = text.substr(i, length);
        const int code = control(character);
        if ((code == '\t' || code == '\n') && lines == Lines::several) continue;
        if (code >= 0)
            return TextFault{i, fmt::format("has a control character ({})", name_of(code)),
                             "Leave it out."};
        if (lines == Lines::one && is_reordering(character))
            return TextFault{i, "has a character that changes the order of those around it",
                             "Leave it out."};
        if (is_mark(character))
            return TextFault{i, "has a byte order mark, or a code that is not a character",
                             "Leave it out."};
    }
    return std::nullopt;
}

void check_text(std::string_view text, const std::string& name, Lines lines) {
    const auto fault = find_fault(text, lines);
    if (!fault) return;
    throw Error({name, 0}, mended(text, Lines::one), fault->what, fault->remedy);
}

std::string mended(std::string_view text, Lines lines) {
    std::string out;
    while (const auto fault = find_fault(text, lines)) {
        out += text.substr(0, fault->at);
        out += kReplacement;
        text.remove_prefix(fault->at);
        text.remove_prefix(std::max<size_t>(1, utf8_length(text)));
    }
    return out.append(text);
}

}  // namespace dihaptic
