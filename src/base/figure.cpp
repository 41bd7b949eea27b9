#include "base/figure.h"

#include <algorithm>
#include <cassert>
#include <cctype>
#include <utility>

#include "base/unit.h"

namespace dihaptic {
namespace {

/// The ending that a unit adds to a name: "N/s" becomes "_N_s", "N*m" becomes "_Nm".
std::string ending(std::string_view unit) {
    std::string out = "_";
    for (const char c : unit) {
        if (c != '*') out += c == '/' ? '_' : c;
    }
    return out;
}

/// Whether the key ends with `end`, ignoring case, because benchmarks write units in lower case:
/// "drag_n".
bool ends_with(std::string_view key, std::string_view end) {
    const auto same = [](char a, char b) { return std::tolower(a) == std::tolower(b); };
    return key.size() >= end.size() && std::equal(end.rbegin(), end.rend(), key.rbegin(), same);
}

}  // namespace

FigureForm figure_form(std::string_view name, std::string_view unit) {
    const std::string key(name);
    if (unit.empty() || unit == "1" || ends_with(key, ending(unit))) return {key, 1};
    const Unit* known = find_unit(ending(unit).substr(1));
    assert(known != nullptr);
    // these two names are defined by NWB
    const bool nwb = name == "start_time" || name == "stop_time";
    return {nwb ? key : key + ending(unit), 1 / known->si};
}

FigureColumn figure_column(std::string_view name, std::string_view unit, std::string_view what) {
    const FigureForm form = figure_form(name, unit);
    return {{form.key, std::string(what), std::string(unit == "1" ? "" : unit)}, form.scale};
}

void add_row(Table& table, FigureLister row) {
    table.columns = std::move(row.columns);
    table.rows.push_back(std::move(row.cells));
}

}  // namespace dihaptic
