// A tabulated path along which a body is driven: positions at given times, read from a file or
// listed in the experiment file itself.
#pragma once

#include <string>
#include <vector>

#include "base/diagnostics.h"
#include "base/field.h"
#include "base/geometry.h"

namespace dihaptic {
class CsvFile;
}

namespace dihaptic::task {

/// Positions at given times. Displacements are relative to the first position, so that a recording
/// in a tracker's own coordinates can be used. An omitted coordinate stays constant.
struct SampledPath {
    std::string file;  ///< CSV file with the columns below, relative to the experiment file
    std::vector<double> times;  ///< ascending [s]
    /// One position for each time, or empty if the coordinate stays constant [m].
    std::vector<double> x;
    std::vector<double> y;
    std::vector<double> z;
    Place place;

    bool is_empty() const noexcept { return file.empty() && times.empty(); }

    template <class Visitor>
    void visit(Visitor& v) {
        const Field way = Field::length().within(-100, 100);
        v("file", file,
          says("CSV file, relative to this file, with the column time_s and any of the columns "
               "x_mm, y_mm and z_mm; a session stores its contents."));
        v("times", times,
          Field::of(Quantity::time).within(0, 3600).says("Ascending times, if no file is given."));
        v("x", x, way.says("Positions along x at these times."));
        v("y", y, way.says("Positions along y at these times."));
        v("z", z, way.says("Positions along z at these times."));
    }

    /// Reads the file, if `file` names one, and then clears `file`. Relative paths start at
    /// `folder`.
    void read_file(const std::string& folder, Diagnostics& diagnostics);
    /// Whether the path is valid. Problems are added to `diagnostics`.
    bool check(Diagnostics& diagnostics) const;
    /// Displacement from the first position at time `t`, counted from the first time [s]. The path
    /// is a cubic curve through all positions, whose slope at each position is that of the line
    /// between the neighbouring positions (Catmull and Rom 1974). The path starts and ends at rest.
    /// Requires a valid path.
    Vec3 way(double t) const noexcept;

  private:
    void read_table(const CsvFile& table, Diagnostics& diagnostics);
};

}  // namespace dihaptic::task
