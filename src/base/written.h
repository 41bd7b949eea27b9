// A YAML document with the position of each part in its text. With it, a part of the text can be
// changed and the rest left as it is, which is impossible by reading (node.h) and rewriting.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "base/node.h"

namespace dihaptic {

/// A YAML document, or a part of it.
struct Written {
    Node::Kind kind = Node::Kind::null;
    size_t at = 0;       ///< position of its first character [bytes]
    int column = 0;      ///< column of the same character, from 0 [bytes]
    bool flow = false;   ///< in brackets
    bool alone = false;  ///< has no alias (*name), anchor (&name) or tag (!name), which would
                         ///< change the meaning
    std::string scalar;
    std::vector<Written> items;  ///< for a mapping: each key, followed by its value

    /// The value of a mapping's key, or null.
    const Written* find(std::string_view key) const;
};

/// Throws Error when the text is not YAML.
Written read_written(const std::string& text);

/// A part of a text that is replaced.
struct TextChange {
    size_t at = 0;      ///< position of its first byte
    size_t length = 0;  ///< [bytes]
    std::string text;   ///< its replacement
};
/// `changes`: in the order of the text, without overlaps.
std::string changed(std::string text, const std::vector<TextChange>& changes);

}  // namespace dihaptic
