// A YAML document with the position of each part in its text. This makes it possible to change one
// part of the text and leave the rest as it is, unlike reading the document (node.h) and writing it
// again.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "base/node.h"

namespace dihaptic {

/// A YAML document, or a part of it.
struct Written {
    Node::Kind kind = Node::Kind::null;
    size_t at = 0;      ///< position of the node's first character [bytes]
    int column = 0;     ///< column of that character, counted from 0 [bytes]
    bool flow = false;  ///< in brackets
    /// Whether the node has no alias (*name), anchor (&name) or tag (!name), any of which would
    /// change its meaning.
    bool alone = false;
    std::string scalar;
    std::vector<Written> items;  ///< for a mapping: each key, followed by its value

    /// The value of a key of a mapping, or null if there is none.
    const Written* find(std::string_view key) const;
};

/// Reads a YAML document with its positions. Throws Error if the text is not YAML.
Written read_written(const std::string& text);

/// A part of a text, and its replacement.
struct TextChange {
    size_t at = 0;      ///< position of the part's first byte
    size_t length = 0;  ///< [bytes]
    std::string text;   ///< its replacement
};
/// Returns the text with the changes applied. `changes` are in the order of the text and do not
/// overlap.
std::string changed(std::string text, const std::vector<TextChange>& changes);

}  // namespace dihaptic
