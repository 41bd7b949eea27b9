#include "task/file/hed.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <set>
#include <string_view>

namespace dihaptic::task {
namespace {

/// Returns a description of `c` if no tag can contain this character, otherwise "".
std::string foreign(char c) {
    if (c == '\t' || c == '\n') return "of a tab or a line break";
    return std::string_view("[]{}~\"").find(c) == std::string_view::npos ? ""
                                                                         : fmt::format("'{}'", c);
}

/// Tags that cannot be used here: they belong in definitions or to whole events, or refer to a cell
/// of another column.
constexpr std::array<std::string_view, 10> kNotHere{
    "onset",      "offset",   "inset", "def", "def-expand",
    "definition", "duration", "delay", "n/a", "event-context"};

std::string fault_of_tag(std::string tag) {
    for (char& c : tag) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    const std::string_view text = tag;
    if (text.starts_with('/') || text.ends_with('/') || text.find("//") != text.npos ||
        text.find('#') != text.npos)
        return fmt::format("has a tag, '{}', with one '/' or '#' too many", tag);
    const std::string_view first = text == "n/a" ? text : text.substr(0, text.find('/'));
    if (std::ranges::find(kNotHere, first) == kNotHere.end()) return "";
    return fmt::format("has the tag '{}', which the export cannot use", tag);
}

/// Reads a list of tags and groups of tags.
class HedReader {
  public:
    explicit HedReader(const std::string& text) : text_(text) {}

    /// Returns the first fault in the text, or "" if there is none.
    std::string fault() {
        const std::string first = list();
        if (!first.empty()) return first;
        return at_ < text_.size() ? "has a ')' without a '('" : "";
    }

  private:
    char next() {
        while (at_ < text_.size() && text_[at_] == ' ') ++at_;
        return at_ < text_.size() ? text_[at_] : '\0';
    }
    std::string list() {
        std::set<std::string> known;
        for (;;) {
            const size_t begin = (next(), at_);
            if (std::string what = item(); !what.empty()) return what;
            std::string words = text_.substr(begin, at_ - begin);
            while (words.ends_with(' ')) words.pop_back();
            if (!known.insert(words).second) return fmt::format("has '{}' twice", words);
            const char after = next();
            if (after == '(') return "has a '(' without a comma before it";
            if (after != ',') return "";
            ++at_;
        }
    }
    std::string item() {
        if (next() == '(') {
            ++at_;
            if (std::string what = list(); !what.empty()) return what;
            if (next() != ')') return "has a '(' without a ')'";
            ++at_;
            const char after = next();
            return after == '\0' || after == ',' || after == ')' || after == '('
                       ? ""
                       : "has a ')' without a comma after it";
        }
        const size_t begin = at_;
        while (at_ < text_.size() &&
               std::string_view(",()").find(text_[at_]) == std::string_view::npos)
            ++at_;
        std::string tag = text_.substr(begin, at_ - begin);
        while (tag.ends_with(' ')) tag.pop_back();
        return tag.empty() ? "has an empty tag" : fault_of_tag(tag);
    }

    const std::string& text_;
    size_t at_ = 0;
};

/// Returns the first fault in the tags, or "" if there is none.
std::string fault_of(const std::string& tags) {
    for (const char c : tags) {
        if (const std::string what = foreign(c); !what.empty())
            return "contains the character " + what;
    }
    return HedReader(tags).fault();
}

}  // namespace

void check_hed(const std::string& tags, const Place& place, Diagnostics& diagnostics) {
    if (tags.empty()) return;
    const std::string fault = fault_of(tags);
    if (fault.empty()) return;
    diagnostics.error(place, "hed", fmt::format("'{}' {}", tags, fault),
                      "Write tags separated by commas, e.g. hed: \"Sensory-event, (Target, "
                      "Visual-presentation)\".");
}

}  // namespace dihaptic::task
