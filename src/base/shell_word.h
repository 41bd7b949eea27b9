// Writes words of a command that somebody, or a shell script, types into a shell as they stand, and
// takes such a command apart again. Names of files may be a stranger's: whatever is in them, a
// shell takes each as one word, and a terminal shows it.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace dihaptic {

/// The word, in quotes if a shell would not take it as it is: in $'...', which bash and zsh know,
/// if it has control characters.
std::string shell_word(const std::string& word);

/// As shell_word(), of a file's name: with ./ before one that begins with a dash, which every
/// program would take for an option.
std::string shell_file(const std::string& name);

/// The words of a command that was put together of shell_word()s; nullopt if a shell would do more
/// with it than to start a program with these words.
std::optional<std::vector<std::string>> shell_words(std::string_view command);

}  // namespace dihaptic
