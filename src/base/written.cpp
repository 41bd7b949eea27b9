#include "base/written.h"

#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/yaml.h>

#include <sstream>

namespace dihaptic {
namespace {

/// yaml-cpp does not count a byte order mark.
constexpr std::string_view kMark = "\xEF\xBB\xBF";

class WrittenBuilder final : public YAML::EventHandler {
  public:
    explicit WrittenBuilder(size_t skipped) : skipped_(skipped) {}
    Written root;

  private:
    void OnDocumentStart(const YAML::Mark&) override {}
    void OnDocumentEnd() override {}
    void OnNull(const YAML::Mark& mark, YAML::anchor_t anchor) override {
        add(part(Node::Kind::null, mark, "", anchor));
    }
    void OnAlias(const YAML::Mark& mark, YAML::anchor_t anchor) override {
        add(part(Node::Kind::null, mark, "", anchor));
    }
    void OnScalar(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                  const std::string& value) override {
        Written out = part(Node::Kind::scalar, mark, tag, anchor);
        out.scalar = value;
        add(std::move(out));
    }
    void OnSequenceStart(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                         YAML::EmitterStyle::value style) override {
        open_.push_back(part(Node::Kind::sequence, mark, tag, anchor));
        open_.back().flow = style == YAML::EmitterStyle::Flow;
    }
    void OnMapStart(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                    YAML::EmitterStyle::value style) override {
        open_.push_back(part(Node::Kind::mapping, mark, tag, anchor));
        open_.back().flow = style == YAML::EmitterStyle::Flow;
    }
    void OnSequenceEnd() override { close(); }
    void OnMapEnd() override { close(); }

    Written part(Node::Kind kind, const YAML::Mark& mark, const std::string& tag,
                 YAML::anchor_t anchor) const {
        Written out;
        out.kind = kind;
        out.at = static_cast<size_t>(std::max(0, mark.pos)) + skipped_;
        out.column = std::max(0, mark.column);
        // yaml-cpp uses the tag ? for nodes without a tag, and ! for quoted texts
        out.alone = anchor == YAML::NullAnchor && (tag.empty() || tag == "?" || tag == "!");
        return out;
    }
    void add(Written&& what) {
        if (open_.empty()) {
            root = std::move(what);
        } else {
            open_.back().items.push_back(std::move(what));
        }
    }
    void close() {
        Written done = std::move(open_.back());
        open_.pop_back();
        add(std::move(done));
    }

    size_t skipped_;
    std::vector<Written> open_;
};

}  // namespace

const Written* Written::find(std::string_view key) const {
    if (kind != Node::Kind::mapping) return nullptr;
    for (size_t i = 0; i + 1 < items.size(); i += 2) {
        if (items[i].scalar == key) return &items[i + 1];
    }
    return nullptr;
}

Written read_written(const std::string& text) {
    WrittenBuilder builder(text.starts_with(kMark) ? kMark.size() : 0);
    try {
        std::istringstream in(text);
        YAML::Parser parser(in);
        parser.HandleNextDocument(builder);
    } catch (const YAML::Exception& e) {
        throw Error({"", e.mark.line + 1}, "", "is not YAML: " + e.msg, "Correct that first.");
    }
    return std::move(builder.root);
}

std::string changed(std::string text, const std::vector<TextChange>& changes) {
    for (auto change = changes.rbegin(); change != changes.rend(); ++change)
        text.replace(change->at, change->length, change->text);
    return text;
}

}  // namespace dihaptic
