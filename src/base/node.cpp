#include "base/node.h"

#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <sstream>

#include "base/text_file.h"

namespace dihaptic {

const Node* Node::find(const std::string& key) const {
    for (const auto& [name, value] : entries) {
        if (name == key) return &value;
    }
    return nullptr;
}

Node Node::of(std::string scalar) {
    Node node;
    node.kind = Kind::scalar;
    node.scalar = std::move(scalar);
    return node;
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

/// An alias (*name) inside what it names never ends, and aliases of aliases double at each level.
constexpr int kDeepest = 32;
constexpr size_t kMostNodes = 1'000'000;

Node convert(const YAML::Node& in, const std::string& file, size_t& count, int depth = 0) {
    Node out;
    out.place = {file, in.Mark().line + 1};
    if (depth > kDeepest || ++count > kMostNodes) {
        throw Error(out.place, "", "is nested too deeply, or too large",
                    "Write it out without aliases (*name).");
    }
    switch (in.Type()) {
        case YAML::NodeType::Scalar:
            out.kind = Node::Kind::scalar;
            out.scalar = in.Scalar();
            break;
        case YAML::NodeType::Sequence:
            out.kind = Node::Kind::sequence;
            for (const auto& item : in) out.items.push_back(convert(item, file, count, depth + 1));
            break;
        case YAML::NodeType::Map:
            out.kind = Node::Kind::mapping;
            for (const auto& entry : in) {
                const Place at{file, entry.first.Mark().line + 1};
                if (!entry.first.IsScalar()) throw Error(at, "", "a key must be a word", "");
                const std::string key = entry.first.Scalar();
                if (out.find(key) != nullptr) {
                    throw Error(at, key, "is given twice", "Keep one of the two lines.");
                }
                Node value = convert(entry.second, file, count, depth + 1);
                value.place = at;
                out.entries.push_back({key, std::move(value)});
            }
            break;
        default:
            break;
    }
    return out;
}

/// The lines at which documents start, from 0.
class DocumentStarts final : public YAML::EventHandler {
  public:
    std::vector<int> lines;

  private:
    void OnDocumentStart(const YAML::Mark&) override { lines.push_back(-1); }
    void OnDocumentEnd() override {}
    void OnNull(const YAML::Mark& mark, YAML::anchor_t) override { see(mark); }
    void OnAlias(const YAML::Mark& mark, YAML::anchor_t) override { see(mark); }
    void OnScalar(const YAML::Mark& mark, const std::string&, YAML::anchor_t,
                  const std::string&) override {
        see(mark);
    }
    void OnSequenceStart(const YAML::Mark& mark, const std::string&, YAML::anchor_t,
                         YAML::EmitterStyle::value) override {
        see(mark);
    }
    void OnSequenceEnd() override {}
    void OnMapStart(const YAML::Mark& mark, const std::string&, YAML::anchor_t,
                    YAML::EmitterStyle::value) override {
        see(mark);
    }
    void OnMapEnd() override {}
    void see(const YAML::Mark& mark) {
        if (lines.back() < 0) lines.back() = mark.line;
    }
};

/// Throws Error where a second document starts. YAML::LoadAll() would read all documents, and never
/// end at a stray comma, which starts none.
void check_single(const std::string& text, const std::string& file) {
    std::istringstream in(text);
    YAML::Parser parser(in);
    DocumentStarts starts;
    while (starts.lines.size() < 2 && parser.HandleNextDocument(starts)) {
    }
    if (starts.lines.size() < 2) return;
    throw Error({file, std::max(0, starts.lines[1]) + 1}, "",
                "a second YAML document starts here (after '---', or after a bracket that closed "
                "the first)",
                "Keep one document a file.");
}

YAML::Node emit(const Node& node) {
    YAML::Node out;
    switch (node.kind) {
        case Node::Kind::null:
            break;
        case Node::Kind::scalar:
            out = node.scalar;
            break;
        case Node::Kind::sequence:
            out = YAML::Node(YAML::NodeType::Sequence);
            for (const Node& item : node.items) out.push_back(emit(item));
            if (std::all_of(node.items.begin(), node.items.end(),
                            [](const Node& item) { return item.kind == Node::Kind::scalar; })) {
                out.SetStyle(YAML::EmitterStyle::Flow);
            }
            break;
        case Node::Kind::mapping:
            out = YAML::Node(YAML::NodeType::Map);
            for (const auto& [key, value] : node.entries) out[key] = emit(value);
            break;
    }
    return out;
}

}  // namespace

Node parse_yaml(const std::string& text, const std::string& file) {
    try {
        check_single(text, file);
        size_t count = 0;
        Node root = convert(YAML::Load(text), file, count);
        root.place.file = file;
        if (root.place.line == 0) root.place.line = 1;
        return root;
    } catch (const YAML::Exception& e) {
        throw Error({file, e.mark.line + 1}, "", "is not YAML: " + e.msg,
                    "Check the indentation (spaces, no tabs) and the brackets near this line.");
    }
}

Node read_yaml(const std::string& file) {
    return parse_yaml(read_text_file(file, kMostYaml), file);
}

std::string to_yaml(const Node& node) {
    YAML::Emitter out;
    out << emit(node);
    return std::string(out.c_str()) + "\n";
}

}  // namespace dihaptic
