// A chart on a report's page: describes its content, not its drawing.
#pragma once

#include <array>
#include <string>
#include <vector>

namespace dihaptic::analysis {

/// faint: a thin line behind the others, without an entry in the legend.
enum class Drawn { line, steps, points, faint };
constexpr auto enum_names(Drawn) {
    return std::array{"line", "steps", "points", "faint"};
}

struct Series {
    std::string name;
    Drawn drawn = Drawn::line;
    std::vector<double> x;  ///< ascending
    std::vector<double> y;  ///< NaN leaves a gap
    /// Interval around each y; empty if there are no intervals.
    std::vector<double> low;
    std::vector<double> high;
    /// "#rrggbb" for quantities with their own colour (base/palette.h); empty: the page chooses.
    std::string colour;

    bool empty() const;  ///< whether it has no finite value
};

/// A line across the chart that marks a change.
struct Mark {
    double x = 0;
    std::string text;
};

struct Chart {
    std::string title;
    std::string x_label;
    std::string y_label;
    std::string caption;  ///< text below the chart, with the origin of the data
    std::vector<Series> series;
    std::vector<Mark> marks;
};

}  // namespace dihaptic::analysis
