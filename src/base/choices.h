// Names that may stand somewhere in a file, for a problem that lists them (Problem::choices).
#pragma once

#include <string>
#include <vector>

#include "base/diagnostics.h"

namespace dihaptic {

template <class Names>
std::vector<Choice> choices_of(const Names& names) {
    std::vector<Choice> out;
    for (const auto& name : names) out.push_back({std::string(name), ""});
    return out;
}

}  // namespace dihaptic
