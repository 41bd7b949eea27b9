#include "task/file/hed.h"

#include <fmt/format.h>

namespace dihaptic::task {
namespace {

/// What a character that no tag may have is, in words; "" if a tag may have it.
std::string foreign(char c) {
    if (c == '\t' || c == '\n') return "of a tab or a line break";
    return std::string_view("[]{}~\"").find(c) == std::string_view::npos ? ""
                                                                         : fmt::format("'{}'", c);
}

/// The fault of the tags; "" if they have none.
std::string fault_of(const std::string& tags) {
    int depth = 0;
    bool is_empty = true;  // since the last comma or parenthesis that opens a group
    for (const char c : tags) {
        if (const std::string what = foreign(c); !what.empty())
            return "contains the character " + what;
        const bool ends = c == ',' || c == ')';
        if (ends && is_empty) return fmt::format("has an empty tag before a '{}'", c);
        if (c == '(') ++depth;
        if (c == ')' && --depth < 0) return "has a ')' without a '('";
        if (c != ' ') is_empty = c == ',' || c == '(';
    }
    if (depth > 0) return "has a '(' without a ')'";
    return is_empty ? "ends with an empty tag" : "";
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
