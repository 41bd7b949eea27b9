// A YAML document as a plain tree that remembers where each value was written.
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
    bool plain = false;          ///< for a scalar: written without quotes, like numbers, yes and no
    std::vector<Node> items;     ///< for a sequence
    std::vector<Entry> entries;  ///< for a mapping, in the order of the file

    /// The value of a mapping's key, or null.
    const Node* find(const std::string& key) const;

    /// A text, which to_yaml() quotes where other programs would read something else.
    static Node of(std::string text);
    /// A number, or any other scalar that is not a text.
    static Node number(double value);
    static Node plain_word(std::string word);
    static Node mapping();
    /// Adds or replaces an entry of a mapping.
    void set(const std::string& key, Node value);
};

struct Node::Entry {
    std::string key;
    Node value;
};

/// Whether control characters, which YAML can escape, are an error or are replaced. Before
/// version 0.3 they got into sessions, whose files were then unreadable.
enum class Words { checked, mended };

/// Reads a YAML file. Throws Error when the file cannot be read, is not YAML, gives a key twice, or
/// contains control characters.
Node read_yaml(const std::string& file);
/// Like read_yaml(), from text, which messages call `file`.
Node parse_yaml(const std::string& text, const std::string& file, Words words = Words::checked);

/// Texts are quoted wherever a reader of YAML 1.1, such as PyYAML or R, would read them as
/// something else: 010 as 8, 1:30 as 90, no as false, a day as a date.
std::string to_yaml(const Node& node);

}  // namespace dihaptic
