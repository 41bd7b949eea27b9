// A YAML document as a plain tree in which each node remembers where it was written.
#pragma once

#include <string>
#include <vector>

#include "base/diagnostics.h"

namespace dihaptic {

/// A YAML document, or a part of it.
struct Node {
    struct Entry;
    enum class Kind { null, scalar, sequence, mapping };

    Kind kind = Kind::null;
    Place place;
    std::string scalar;
    bool plain = false;          ///< for a scalar: whether it is unquoted, like numbers, yes and no
    std::vector<Node> items;     ///< the items of a sequence
    std::vector<Entry> entries;  ///< the entries of a mapping, in the order of the file

    /// The value of a key of a mapping, or null if there is none.
    const Node* find(const std::string& key) const;

    /// Makes a text node, which to_yaml() quotes if other programs would read it as something else.
    static Node of(std::string text);
    /// Makes a node from a number, or from any other scalar that is not a text.
    static Node number(double value);
    static Node plain_word(std::string word);
    static Node mapping();
    /// Sets the value of a key of a mapping, and adds the key if it is missing.
    void set(const std::string& key, Node value);
};

struct Node::Entry {
    std::string key;
    Node value;
};

/// Whether control characters, which YAML can escape, are treated as errors or replaced. Before
/// version 0.3, some sessions contained control characters, which made their files unreadable.
enum class Words { checked, mended };

/// Reads a YAML file. Throws Error if the file cannot be read, is not YAML, gives a key twice, or
/// contains control characters.
Node read_yaml(const std::string& file);
/// Like read_yaml(), but reads the document from `text`; `file` is its name in messages.
Node parse_yaml(const std::string& text, const std::string& file, Words words = Words::checked);

/// Converts a node to YAML. Texts are quoted wherever a YAML 1.1 reader, such as PyYAML or R, would
/// read them as something else: 010 as 8, 1:30 as 90, no as false, a day as a date.
std::string to_yaml(const Node& node);

}  // namespace dihaptic
