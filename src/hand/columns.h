// The meaning of the cells in a movement's lines, as given by its first lines.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "base/diagnostics.h"
#include "base/given_table.h"

namespace dihaptic::hand {

struct Columns {
    std::vector<std::string> keys;  ///< names for messages
    int time = -1;                  ///< -1: derived from the line count
    double time_unit = 1;           ///< of the time column, or the time between lines [s]
    int occluded = -1;
    struct Finger {
        std::string name;
        std::string unit_name;
        double unit = 1;
        std::array<int, 3> axis{-1, -1, -1};
    };
    std::vector<Finger> fingers;
    bool exported =
        false;  ///< whether a tracker's own program wrote it, which may add further cells

    const std::string& key(int column) const { return keys[static_cast<size_t>(column)]; }
};

/// The columns of a file exported by a tracker's own program: Motive and Nexus (CSV), or Qualisys
/// (TSV). Each marker is the finger of the same name, without the asset's name before a colon.
/// `first` is the file's first line; `table` is left at the line after the header. nullopt if the
/// file is none of these. Throws Error if the header does not define the numbers.
std::optional<Columns> read_export(const std::vector<std::string>& first, GivenTable& table);

}  // namespace dihaptic::hand
