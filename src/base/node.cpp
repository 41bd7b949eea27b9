#include "base/node.h"

#include <fmt/format.h>
#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <cctype>
#include <map>
#include <optional>
#include <sstream>
#include <utility>

#include "base/number.h"
#include "base/text.h"
#include "base/text_file.h"
#include "base/unsaved.h"

namespace dihaptic {

const Node* Node::find(const std::string& key) const {
    for (const auto& [name, value] : entries) {
        if (name == key) return &value;
    }
    return nullptr;
}

Node Node::of(std::string text) {
    Node node;
    node.kind = Kind::scalar;
    node.scalar = std::move(text);
    return node;
}

Node Node::plain_word(std::string word) {
    Node node = of(std::move(word));
    node.plain = true;
    return node;
}

Node Node::number(double value) {
    std::string text = number_text(value);
    // without a decimal point, PyYAML would read 1e-05 as text
    if (const size_t e = text.find('e'); e != std::string::npos && text.find('.') > e)
        text.insert(e, ".0");
    return plain_word(std::move(text));
}

Node Node::mapping() {
    Node node;
    node.kind = Kind::mapping;
    return node;
}

void Node::set(const std::string& key, Node value) {
    for (auto& [name, old] : entries) {
        if (name == key) {
            old = std::move(value);
            return;
        }
    }
    entries.push_back({key, std::move(value)});
}

namespace {

/// Limits for aliases: an alias (*name) inside the node that it refers to would never end, and
/// aliases of aliases can double the document's size at each level.
constexpr size_t kDeepest = 32;
constexpr size_t kMostNodes = 500'000;

/// Builds the tree while the text is being read, so that excessive nesting or size is refused at
/// once. YAML::Load() is not used because each look-up of a key in its tree searches all the keys.
class TreeBuilder final : public YAML::EventHandler {
  public:
    TreeBuilder(const std::string& file, Words words) : file_(file), words_(words) {
        root_.place = {file, 1};
    }

    Node take() { return std::move(root_); }

  private:
    /// A list or mapping whose end has not yet been read.
    struct Open {
        Node node;
        YAML::anchor_t anchor;
        size_t count;       // number of nodes before this one
        size_t height = 0;  // number of levels below this node
        std::optional<Node> key = std::nullopt;
    };
    struct Named {
        Node node;
        size_t count;
        size_t height;
    };

    void OnDocumentStart(const YAML::Mark&) override { ++documents_; }
    // a stray comma counts as an empty document
    void OnDocumentEnd() override { check_single(file_place(0)); }
    void OnNull(const YAML::Mark& mark, YAML::anchor_t anchor) override {
        add(begin(Node::Kind::null, mark), anchor);
    }
    void OnScalar(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                  const std::string& text) override {
        Node node = begin(Node::Kind::scalar, mark);
        node.scalar = text;
        node.plain = tag == "?";  // yaml-cpp's tag for scalars without quotes
        if (const auto fault = find_fault(text)) {
            node.scalar = mended(text);
            if (words_ == Words::checked)
                throw Error(node.place, shortened(node.scalar), fault->what, fault->remedy);
        }
        add(std::move(node), anchor);
    }
    void OnSequenceStart(const YAML::Mark& mark, const std::string&, YAML::anchor_t anchor,
                         YAML::EmitterStyle::value) override {
        open(begin(Node::Kind::sequence, mark), anchor);
    }
    void OnMapStart(const YAML::Mark& mark, const std::string&, YAML::anchor_t anchor,
                    YAML::EmitterStyle::value) override {
        open(begin(Node::Kind::mapping, mark), anchor);
    }
    void OnSequenceEnd() override { close(); }
    void OnMapEnd() override {
        check_keys(open_.back().node);
        close();
    }
    void OnAlias(const YAML::Mark& mark, YAML::anchor_t anchor) override;

    Place file_place(int line) const { return {file_, line + 1}; }
    void check_single(const Place& place) const;
    void check_size(const Place& place, size_t height) const;
    static void check_keys(const Node& mapping);
    Node begin(Node::Kind kind, const YAML::Mark& mark);
    void open(Node node, YAML::anchor_t anchor) {
        const size_t before = count_ - 1;
        open_.push_back({std::move(node), anchor, before});
    }
    void close();
    /// Adds a value that has been read completely.
    void add(Node node, YAML::anchor_t anchor, size_t count = 1, size_t height = 0);
    void put(Node node);

    const std::string& file_;
    const Words words_;
    int documents_ = 0;
    size_t count_ = 0;
    std::vector<Open> open_;
    std::map<YAML::anchor_t, Named> named_;
    Node root_;
};

void TreeBuilder::check_single(const Place& place) const {
    if (documents_ < 2) return;
    throw Error(place, "",
                "a second YAML document starts here (after '---', or after a bracket that closed "
                "the first)",
                "Keep one document per file.");
}

/// Checks the number of nodes and the depth of nesting; `height` is the number of levels below the
/// node that starts here.
void TreeBuilder::check_size(const Place& place, size_t height) const {
    if (open_.size() + height > kDeepest)
        throw Error(place, "", fmt::format("is nested too deeply: more than {} levels", kDeepest),
                    "Look for brackets that are not closed, or write it out without aliases "
                    "(*name).");
    if (count_ > kMostNodes)
        throw Error(place, "",
                    fmt::format("is too large: from here on it has more than {} keys and values",
                                kMostNodes),
                    "Check that it is the right file; aliases (*name) count as if they were "
                    "written out.");
}

void TreeBuilder::check_keys(const Node& mapping) {
    std::vector<const Node::Entry*> sorted;
    sorted.reserve(mapping.entries.size());
    for (const Node::Entry& entry : mapping.entries) sorted.push_back(&entry);
    std::stable_sort(sorted.begin(), sorted.end(),
                     [](const auto* a, const auto* b) { return a->key < b->key; });
    const Node::Entry* second = nullptr;
    for (size_t i = 1; i < sorted.size(); ++i) {
        if (sorted[i - 1]->key == sorted[i]->key && (second == nullptr || sorted[i] < second))
            second = sorted[i];
    }
    if (second == nullptr) return;
    throw Error(second->value.place, second->key, "is given twice", "Keep one of the two lines.");
}

Node TreeBuilder::begin(Node::Kind kind, const YAML::Mark& mark) {
    Node node;
    node.kind = kind;
    node.place = file_place(mark.line);
    check_single(node.place);
    ++count_;
    check_size(node.place, 0);
    return node;
}

void TreeBuilder::OnAlias(const YAML::Mark& mark, YAML::anchor_t anchor) {
    const Place place = file_place(mark.line);
    check_single(place);
    const auto named = named_.find(anchor);
    if (named == named_.end())
        throw Error(place, "",
                    "an alias (*name) is inside the part that it refers to, which never ends",
                    "Write it out without the alias.");
    const auto& [node, count, height] = named->second;
    count_ += count;
    check_size(place, height);
    add(node, 0, count, height);
}

void TreeBuilder::close() {
    Open whole = std::move(open_.back());
    open_.pop_back();
    add(std::move(whole.node), whole.anchor, count_ - whole.count, whole.height);
}

void TreeBuilder::add(Node node, YAML::anchor_t anchor, size_t count, size_t height) {
    if (!open_.empty()) open_.back().height = std::max(open_.back().height, height + 1);
    if (anchor != 0) {
        count_ += count;  // the value is stored twice
        check_size(node.place, 0);
        named_[anchor] = {node, count, height};
    }
    put(std::move(node));
}

void TreeBuilder::put(Node node) {
    if (open_.empty()) {
        root_ = std::move(node);
        return;
    }
    Open& parent = open_.back();
    if (parent.node.kind == Node::Kind::sequence) {
        parent.node.items.push_back(std::move(node));
    } else if (parent.key) {
        node.place = parent.key->place;
        parent.node.entries.push_back({std::move(parent.key->scalar), std::move(node)});
        parent.key.reset();
    } else if (node.kind == Node::Kind::scalar) {
        parent.key = std::move(node);
    } else {
        throw Error(node.place, "", "a key must be a word", "");
    }
}

bool is_one_of(std::string_view word, std::initializer_list<std::string_view> words) {
    const auto same = [](char a, char b) {
        return (a >= 'A' && a <= 'Z' ? a - 'A' + 'a' : a) == b;
    };
    return std::any_of(words.begin(), words.end(), [&](std::string_view w) {
        return std::equal(word.begin(), word.end(), w.begin(), w.end(), same);
    });
}

/// Whether YAML 1.1, like this program, reads the word as a Boolean value.
bool is_truth(std::string_view word) {
    return is_one_of(word, {"yes", "no", "true", "false", "on", "off"});
}

/// Whether YAML 1.1 may read an unquoted text as something else (yaml.org/type/), because it starts
/// like a number or with a sign, or is one of YAML's own words.
bool reads_otherwise(std::string_view text) {
    const auto begins_word = [](char c) {
        return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_' || c == '/' ||
               (c & 0x80) != 0;
    };
    return text.empty() || !begins_word(text[0]) || is_truth(text) ||
           is_one_of(text, {"y", "n", "null"});
}

/// Whether YAML 1.1 reads the word as the same number as this program, which is not the case for
/// 010, 1e3 and 1_000.
bool is_yaml_number(std::string_view word) {
    if (!finite_number(word)) return false;
    if (word[0] == '+' || word[0] == '-') word.remove_prefix(1);
    const auto is_digit = [&](size_t i) {
        return i < word.size() && word[i] >= '0' && word[i] <= '9';
    };
    if (!is_digit(0) || (word[0] == '0' && is_digit(1))) return false;
    const size_t e = word.find_first_of("eE");
    return e == std::string_view::npos || (word.find('.') < e && e + 1 < word.size() &&
                                           (word[e + 1] == '+' || word[e + 1] == '-'));
}

void emit_text(const std::string& text, YAML::Emitter& out) {
    // YAML 1.1 treats these two characters as line endings
    if (text.find("\u2028") != std::string::npos || text.find("\u2029") != std::string::npos)
        out << YAML::EscapeNonAscii << YAML::DoubleQuoted;
    else if (reads_otherwise(text))
        out << YAML::DoubleQuoted;
    out << text;
}

void emit(const Node& node, YAML::Emitter& out) {
    switch (node.kind) {
        case Node::Kind::null:
            out << YAML::Null;
            break;
        case Node::Kind::scalar:
            if (node.plain && (is_truth(node.scalar) || is_yaml_number(node.scalar))) {
                out << node.scalar;
            } else {
                emit_text(node.scalar, out);
            }
            break;
        case Node::Kind::sequence:
            if (std::all_of(node.items.begin(), node.items.end(),
                            [](const Node& item) { return item.kind == Node::Kind::scalar; }))
                out << YAML::Flow;
            out << YAML::BeginSeq;
            for (const Node& item : node.items) emit(item, out);
            out << YAML::EndSeq;
            break;
        case Node::Kind::mapping:
            out << YAML::BeginMap;
            for (const auto& [key, value] : node.entries) {
                out << YAML::Key;
                emit_text(key, out);
                out << YAML::Value;
                emit(value, out);
            }
            out << YAML::EndMap;
            break;
    }
}

}  // namespace

namespace {

/// Whether, inside brackets, an unquoted text ends with a question mark, which yaml-cpp takes for
/// the beginning of a key. `line` is counted from 0.
bool ends_with_question(const std::string& text, int line) {
    std::istringstream in(text);
    std::string one;
    for (int i = 0; i <= line; ++i) std::getline(in, one);
    return one.find("?,") != std::string::npos || one.find("?}") != std::string::npos ||
           one.find("? }") != std::string::npos || one.find("?]") != std::string::npos;
}

/// The line before `line` that has a text, if that text is a lone word: a key that is being typed,
/// which YAML takes for a text, so that it complains about the line after it. Returns the word and
/// its line, or "" if there is none. Lines are counted from 0.
std::pair<std::string, int> lone_word_before(const std::string& text, int line) {
    std::istringstream in(text);
    std::string one, last;
    int at = 0;
    for (int i = 0; i < line && std::getline(in, one); ++i) {
        const size_t begin = one.find_first_not_of(' ');
        if (begin == std::string::npos || one[begin] == '#') continue;
        last = one.substr(begin, one.find_last_not_of(" \r") + 1 - begin);
        at = i;
    }
    const auto in_word = [](unsigned char c) { return std::isalnum(c) != 0 || c == '_'; };
    if (!std::ranges::all_of(last, in_word)) last.clear();
    return {last, at};
}

}  // namespace

Node parse_yaml(const std::string& text, const std::string& file, Words words) {
    try {
        std::istringstream in(text);
        YAML::Parser parser(in);
        TreeBuilder builder(file, words);
        // the second document is refused here; YAML::LoadAll() would never end at a stray comma
        while (parser.HandleNextDocument(builder)) {
        }
        return builder.take();
    } catch (const YAML::Exception& e) {
        // if a comment follows the word, YAML complains about the word's own line
        const bool in_line = e.msg == YAML::ErrorMsg::END_OF_MAP;
        const auto [word, line] = lone_word_before(text, e.mark.line + (in_line ? 1 : 0));
        if (!word.empty() && (in_line || e.msg == YAML::ErrorMsg::MAP_VALUE))
            throw Error({file, line + 1}, word, "is a key without a value",
                        fmt::format("Write e.g. {}: 1, with a colon.", word));
        throw Error({file, e.mark.line + 1}, "", "is not YAML: " + e.msg,
                    ends_with_question(text, e.mark.line)
                        ? "Put a text that ends with a question mark in quotes."
                        : "Check the indentation (spaces, no tabs) and the brackets near this "
                          "line.");
    }
}

Node read_yaml(const std::string& file) {
    if (const std::string* text = Unsaved::text_of(file)) return parse_yaml(*text, file);
    return parse_yaml(read_text_file(file, kMostYaml), file);
}

std::string to_yaml(const Node& node) {
    YAML::Emitter out;
    emit(node, out);
    return std::string(out.c_str()) + "\n";
}

}  // namespace dihaptic
