#include "base/shell_word.h"

#include <fmt/format.h>

#include <algorithm>

namespace dihaptic {
namespace {

/// Whether shells and sbatch take a character literally.
bool is_plain(char letter) {
    constexpr std::string_view kPlain =
        "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_@+=:,./-";
    return kPlain.find(letter) != std::string_view::npos;
}

bool is_control(char letter) {
    const auto code = static_cast<unsigned char>(letter);
    return code < ' ' || code == 0x7f;
}

std::string with_escapes(const std::string& word) {
    std::string out = "$'";
    for (const char letter : word) {
        if (is_control(letter)) {
            out += fmt::format("\\{:03o}", static_cast<unsigned char>(letter));
        } else {
            out += letter == '\'' || letter == '\\' ? std::string("\\") + letter
                                                    : std::string(1, letter);
        }
    }
    return out + "'";
}

}  // namespace

std::string shell_word(const std::string& word) {
    if (!word.empty() && std::ranges::all_of(word, is_plain)) return word;
    if (std::ranges::any_of(word, is_control)) return with_escapes(word);
    std::string out = "'";
    for (const char letter : word)
        out += letter == '\'' ? std::string("'\\''") : std::string(1, letter);
    return out + "'";
}

std::string shell_file(const std::string& name) {
    return shell_word(name.starts_with('-') ? "./" + name : name);
}

std::optional<std::vector<std::string>> shell_words(std::string_view command) {
    std::vector<std::string> out;
    for (size_t at = 0; at < command.size();) {
        std::string word;
        bool quoted = false;
        size_t end = at;
        for (; end < command.size() && (quoted || command[end] != ' '); ++end) {
            const char letter = command[end];
            if (letter == '\'') {
                quoted = !quoted;
            } else if (!quoted && command.substr(end).starts_with("\\'")) {
                word += '\'';
                ++end;
            } else {
                word += letter;
            }
        }
        // a word that shell_word() would write differently has another meaning in a shell
        if (shell_word(word) != command.substr(at, end - at)) return std::nullopt;
        out.push_back(word);
        at = end + 1;
    }
    return out;
}

}  // namespace dihaptic
