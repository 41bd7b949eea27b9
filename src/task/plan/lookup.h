// Looks up names in experiment files, and reports errors for unknown names.
#pragma once

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "base/choices.h"
#include "base/diagnostics.h"
#include "base/geometry.h"

namespace dihaptic::task {

template <class List>
std::vector<std::string> names_of(const List& list) {
    std::vector<std::string> out;
    for (const auto& item : list) out.push_back(item.name);
    return out;
}

/// Whether the text consists of one or more letters, digits and underscores.
inline bool is_word(std::string_view text) {
    const auto letter = [](char c) {
        return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_';
    };
    return !text.empty() && std::all_of(text.begin(), text.end(), letter);
}

/// Returns the index of `name` in `names`. If there is none, returns -1 and reports the error "'x'
/// is `what`".
inline int look_up(const std::vector<std::string>& names, const std::string& name,
                   const Place& place, const std::string& key, const std::string& what,
                   Diagnostics& diagnostics) {
    const auto found = std::find(names.begin(), names.end(), name);
    if (found != names.end()) return static_cast<int>(found - names.begin());
    const bool explained = diagnostics.problems().size() <= kMostExplained;
    diagnostics.error(
        place, key, name.empty() ? "is missing" : fmt::format("'{}' is {}", name, what),
        names.empty() ? "None is defined: add one first." : meant(name, names, diagnostics),
        explained ? choices_of(names) : std::vector<Choice>{});
    return -1;
}

/// Returns the unit vector along the given vector. If there is none, returns z and reports an
/// error.
inline Vec3 axis_of(const std::optional<Vec3>& given, const Place& place, const char* key,
                    Diagnostics& diagnostics) {
    constexpr double kSmall = 1e-9;
    if (given && given->norm() > kSmall) return given->normalized();
    diagnostics.error(place, key, given ? "has no direction" : "is missing",
                      fmt::format("Write it in world axes, e.g. {}: [0, 0, 1].", key));
    return Vec3::UnitZ();
}

/// Reports an error for each name that occurs more than once.
template <class T>
void check_names(const std::vector<T>& list, const char* what, Diagnostics& diagnostics) {
    std::set<std::string_view> names;
    for (const T& item : list) {
        if (item.name.empty() || names.insert(item.name).second) continue;
        diagnostics.error(item.place, "name", fmt::format("there are two {} '{}'", what, item.name),
                          "Give each a different name.");
    }
}

}  // namespace dihaptic::task
