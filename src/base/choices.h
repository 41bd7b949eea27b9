// The names that are allowed at a given place in a file, listed in a problem report
// (Problem::choices).
//
// A file may contain thousands of names and thousands of mistakes. A problem therefore lists only
// some of the names, and only the first hundred problems come with suggestions.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <vector>

#include "base/diagnostics.h"

namespace dihaptic {

constexpr size_t kMostExplained = 100;  // problems
constexpr size_t kMostListed = 50;      // names

template <class Names>
std::vector<Choice> choices_of(const Names& names) {
    std::vector<Choice> out;
    for (const auto& name : names) {
        if (out.size() == kMostExplained * kMostListed) break;
        out.push_back({std::string(name), ""});
    }
    return out;
}

/// The names separated by commas: "a, b, c", or only the first few if there are many.
inline std::string listed(const std::vector<std::string>& names) {
    std::string out;
    for (size_t i = 0; i < std::min(names.size(), kMostListed); ++i)
        out += (i > 0 ? ", " : "") + names[i];
    if (names.size() > kMostListed) out += fmt::format(" and {} more", names.size() - kMostListed);
    return out;
}

/// The remedy for a name that is not among `names`: "Did you mean x?", or "Known: x, y.".
inline std::string meant(const std::string& name, const std::vector<std::string>& names,
                         const Diagnostics& so_far, const char* these = "Known:") {
    if (so_far.problems().size() > kMostExplained) return "";
    const std::string guess = nearest(name, names);
    return guess.empty() ? fmt::format("{} {}.", these, listed(names))
                         : fmt::format("Did you mean {}?", guess);
}

}  // namespace dihaptic
