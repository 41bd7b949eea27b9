// The meaning of the cells in the lines of a movement file, as given by the file's first lines.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "base/diagnostics.h"
#include "base/given_table.h"

namespace dihaptic::hand {

struct Columns {
    std::vector<std::string> keys;  ///< column names, for messages
    int time = -1;                  ///< -1 if the time is derived from the line count
    double time_unit = 1;           ///< unit of the time column, or the time between lines [s]
    int occluded = -1;
    struct Finger {
        std::string name;
        std::string unit_name;
        double unit = 1;
        std::array<int, 3> axis{-1, -1, -1};
    };
    std::vector<Finger> fingers;
    bool exported = false;  ///< whether the file was written by a tracker's own program, which may
                            ///< add further cells

    const std::string& key(int column) const { return keys[static_cast<size_t>(column)]; }
};

/// Reads the columns of a file exported by a tracker's own program: Motive and Nexus (CSV), or
/// Qualisys (TSV). Each marker is taken as the finger of the same name; a prefix with the asset's
/// name and a colon is ignored. `first` is the first line of the file; `table` is left at the line
/// after the header. Returns nullopt if the file is none of these. Throws Error if the header does
/// not define the meaning of the numbers.
std::optional<Columns> read_export(const std::vector<std::string>& first, GivenTable& table);

}  // namespace dihaptic::hand
