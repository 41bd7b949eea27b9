// A YAML document with the place of each part in its text. It serves to change a part of the text
// and leave the rest as it is, which reading (node.h) and writing again would not do.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "base/node.h"

namespace dihaptic {

/// A YAML document, or a part of it.
struct Written {
    Node::Kind kind = Node::Kind::null;
    size_t at = 0;       ///< of its first sign [bytes]
    int column = 0;      ///< of the same, from 0 [bytes]
    bool flow = false;   ///< in brackets
    bool alone = false;  ///< no alias (*name), anchor (&name) or tag (!name): nothing else is meant
    std::string scalar;
    std::vector<Written> items;  ///< of a mapping, each key with its value behind it

    /// The value of a mapping's key, or null.
    const Written* find(std::string_view key) const;
};

/// Throws Error when the text is not YAML.
Written read_written(const std::string& text);

/// A part of a text that is replaced.
struct TextChange {
    size_t at = 0;      ///< of its first byte
    size_t length = 0;  ///< [bytes]
    std::string text;   ///< in its place
};
/// `changes`: in the order of the text, and apart.
std::string changed(std::string text, const std::vector<TextChange>& changes);

}  // namespace dihaptic
