// Text files. Those that people hand in are in any encoding, or no text at all: what this program
// reads of them goes through here, so that messages about it never show raw bytes.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace dihaptic {

/// Bytes that a text file may have: ten minutes of ten fingers at 5 kHz fit.
constexpr int64_t kMostText = 500'000'000;
/// The same of a YAML file, and of a table.
constexpr int64_t kMostYaml = 16'000'000;
constexpr int64_t kMostTable = 200'000'000;

/// The file's text, without a byte order mark. Throws Error when it is no regular file, is larger
/// than `most`, cannot be opened, or is not UTF-8 text.
std::string read_text_file(const std::string& file, int64_t most = kMostText);

/// Before work whose result goes to `file`: throws Error when write_file() could not write there
/// now, or when that is the file that the work begins with. `what`: that one, in words.
void check_output(const std::string& file, const std::string& input, const std::string& what);
/// Whether what was written is on the disk at once, or when the system has time for it.
enum class Keep { in_time, at_once };
/// Replaces a file's content so that a reader sees either the old or the new; when it is kept at
/// once, after a loss of power too. Throws Error when it cannot.
void write_file(const std::string& text, const std::string& file, Keep keep = Keep::in_time);

/// Of a file, or folder, in the making: under this name it goes as `file`.PROCESS.part.
std::string part_name(const std::string& file);
/// Removes the parts of `file` whose programs ended before they were whole: those were killed.
void remove_dead_parts(const std::string& file);

/// The number that all of a word says, "+1e3" too; nothing when it says none, or one that is not
/// finite.
std::optional<double> finite_number(std::string_view word);

/// A word of a file, short enough to be quoted in a message.
std::string shortened(const std::string& text);

}  // namespace dihaptic
