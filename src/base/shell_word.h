// Quotes the words of a command that a person or a script will type into a shell, and splits such a
// command again. File names may come from strangers, so whatever a name contains, a shell must read
// it as one word, and a terminal must be able to show it.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace dihaptic {

/// The word, quoted if a shell would interpret it. A word with control characters is written as
/// $'...', which bash and zsh support.
std::string shell_word(const std::string& word);

/// Like shell_word(), for a file name. A name that starts with a dash, which programs would read as
/// an option, is preceded by ./.
std::string shell_file(const std::string& name);

/// Splits a command that was made with shell_word() into words; nullopt if a shell would do more
/// than start a program with these words.
std::optional<std::vector<std::string>> shell_words(std::string_view command);

}  // namespace dihaptic
