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
    std::vector<Node> items;     ///< of a sequence
    std::vector<Entry> entries;  ///< of a mapping, in the order of the file

    /// The value of a mapping's key, or null.
    const Node* find(const std::string& key) const;

    static Node of(std::string scalar);
    static Node mapping();
    /// Adds or replaces an entry of a mapping.
    void set(const std::string& key, Node value);
};

struct Node::Entry {
    std::string key;
    Node value;
};

/// Reads a YAML file.
/// Throws Error when the file cannot be read, is not YAML, or gives a key twice.
Node read_yaml(const std::string& file);
/// As read_yaml(), from text; messages call it `file`.
Node parse_yaml(const std::string& text, const std::string& file);

std::string to_yaml(const Node& node);

}  // namespace dihaptic
