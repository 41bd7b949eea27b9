#include "outlets/outlet.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace dihaptic::outlets {

const Kind* find_kind(const std::string& name) {
    for (const Kind& kind : kinds()) {
        if (name == kind.name) return &kind;
    }
    return nullptr;
}

void check(const std::vector<OutletConfig>& outlets, Diagnostics& diagnostics) {
    for (const OutletConfig& outlet : outlets) {
        if (const Kind* kind = find_kind(outlet.kind)) {
            kind->check(outlet, diagnostics);
        } else if (!outlet.kind.empty()) {
            std::vector<std::string> names;
            for (const Kind& known : kinds()) names.emplace_back(known.name);
            diagnostics.error(outlet.place, "kind", fmt::format("'{}' is not known", outlet.kind),
                              fmt::format("Known: {}.", fmt::join(names, ", ")));
        }
    }
}

}  // namespace dihaptic::outlets
