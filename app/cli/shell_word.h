// Writes words of a command that somebody, or a shell script, types into a shell as they stand.
#pragma once

#include <string>
#include <string_view>

namespace dihaptic::cli {

/// Whether a letter means itself to shells, and to sbatch.
inline bool is_plain(char letter) {
    constexpr std::string_view kPlain =
        "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_@+=:,./-";
    return kPlain.find(letter) != std::string_view::npos;
}

/// The word, in quotes if a shell would not take it as it is.
inline std::string shell_word(const std::string& word) {
    bool plain = !word.empty();
    std::string quoted = "'";
    for (const char letter : word) {
        plain = plain && is_plain(letter);
        quoted += letter == '\'' ? std::string("'\\''") : std::string(1, letter);
    }
    return plain ? word : quoted + "'";
}

}  // namespace dihaptic::cli
