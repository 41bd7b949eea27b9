// Reads and writes text files. Files from users may be in any encoding, or may not be text at all.
// All of them are read by these functions, so that messages never contain raw bytes.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace dihaptic {

/// Size limit of a text file [bytes]: enough for ten minutes of recordings of ten fingers at 5 kHz.
constexpr int64_t kMostText = 500'000'000;
/// Size limits of a YAML file and of a table [bytes].
constexpr int64_t kMostYaml = 16'000'000;
constexpr int64_t kMostTable = 200'000'000;

/// Returns the text of the file, without a byte order mark. Throws Error if the file is not a
/// regular file, is larger than `most` [bytes], cannot be opened, or is not UTF-8 text.
std::string read_text_file(const std::string& file, int64_t most = kMostText);

/// Must be called before work whose result will be written to `file`. Throws Error if write_file()
/// could not write there now, or if `file` is the same as `input`, the file that the work reads.
/// `what` describes the input in words.
void check_output(const std::string& file, const std::string& input, const std::string& what);
/// Whether a file is synchronised to the disk at once, or when the system chooses to do so.
enum class Keep { in_time, at_once };
/// Replaces the content of a file in such a way that a reader sees either the old or the new
/// content; with Keep::at_once, this holds even after a loss of power. Throws Error if the file
/// cannot be written, or if its name is a link: nothing is ever written through a link.
void write_file(const std::string& text, const std::string& file, Keep keep = Keep::in_time);

/// Returns a text from a file, shortened to at most 40 bytes for use in a message.
std::string shortened(const std::string& text);

}  // namespace dihaptic
