// Quotes the words of a command that a person or a script will type into a shell, and splits such a
// command again. File names may come from strangers: whatever a name contains, a shell reads it as
// one word, and a terminal shows it.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace dihaptic {

/// The word, quoted if a shell would interpret it; in $'...', which bash and zsh support, if
/// it has control characters.
std::string shell_word(const std::string& word);

/// Like shell_word(), for a file name: one that starts with a dash, which every program would read
/// as an option, is preceded by ./.
std::string shell_file(const std::string& name);

/// The words of a command that was made with shell_word(); nullopt if a shell would do more than
/// start a program with these words.
std::optional<std::vector<std::string>> shell_words(std::string_view command);

}  // namespace dihaptic
