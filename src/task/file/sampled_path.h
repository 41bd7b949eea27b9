// A path that a body is driven along, as a table has it: places at times, from a file or written in
// the experiment.
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

/// Places at times. A way is counted from the first of them, so that a recording in the coordinates
/// of its own tracker can be used. An axis that is left out stays where it is.
struct SampledPath {
    std::string file;           ///< CSV with the columns below, relative to the experiment's file
    std::vector<double> times;  ///< ascending [s]
    std::vector<double> x;      ///< at these, as many, or none [m]
    std::vector<double> y;
    std::vector<double> z;
    Place place;

    bool is_empty() const noexcept { return file.empty() && times.empty(); }

    template <class Visitor>
    void visit(Visitor& v) {
        const Field way = Field::length().within(-100, 100);
        v("file", file,
          says("CSV file with the columns time_s, and x_mm, y_mm, z_mm or some of these, relative "
               "to "
               "this file; a session keeps what is in it."));
        v("times", times,
          Field::of(Quantity::time).within(0, 3600).says("Times, ascending, without a file."));
        v("x", x, way.says("Places along x at these times."));
        v("y", y, way.says("Places along y at these times."));
        v("z", z, way.says("Places along z at these times."));
        if constexpr (requires { v.place(); }) place = v.place();
    }

    /// Reads the file, if there is one, that lies in `folder` or elsewhere, and forgets its name.
    void read_file(const std::string& folder, Diagnostics& diagnostics);
    /// Whether it can be followed; what is wrong goes to `diagnostics`.
    bool check(Diagnostics& diagnostics) const;
    /// The way from the first place at `t` since the first time [s]: a cubic curve through all
    /// places, with the slope from neighbour to neighbour at each (Catmull and Rom 1974), at rest
    /// at both ends. Needs a path that can be followed.
    Vec3 way(double t) const noexcept;

  private:
    void read_table(const CsvFile& table, Diagnostics& diagnostics);
};

}  // namespace dihaptic::task
