// Text files. Those that people hand in are in any encoding, or no text at all: what this program
// reads of them goes through here, so that messages about it never show raw bytes.
#pragma once

#include <string>

namespace dihaptic {

/// The file's text, without a byte order mark. Throws Error when the file is a folder, cannot be
/// opened, or is not UTF-8 text.
std::string read_text_file(const std::string& file);

/// Throws Error when write_file() could not write there now: before work whose result it is to
/// keep.
void check_writable(const std::string& file);
/// Replaces a file's content so that a reader sees either the old or the new. Throws Error when it
/// cannot.
void write_file(const std::string& text, const std::string& file);

/// A word of a file, short enough to be quoted in a message.
std::string shortened(const std::string& text);

}  // namespace dihaptic
