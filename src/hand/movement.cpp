#include "hand/movement.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <limits>
#include <map>
#include <optional>

#include "base/unit.h"

namespace dihaptic::hand {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr size_t kMostErrors = 20;  // of one file: more are no help

std::vector<std::string> split(const std::string& line) {
    std::vector<std::string> cells(1);
    for (const char c : line) {
        if (c == ',') {
            cells.emplace_back();
        } else if (c != '\r' && c != ' ' && c != '\t') {
            cells.back() += c;
        }
    }
    return cells;
}

bool is_missing(const std::string& cell) {
    std::string lower;
    for (const char c : cell)
        lower += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    return lower.empty() || lower == "nan" || lower == "na";
}

std::optional<double> number(const std::string& cell) {
    double value = 0;
    const char* first = cell.data() + (cell.starts_with('+') ? 1 : 0);
    const char* last = cell.data() + cell.size();
    const auto [end, status] = std::from_chars(first, last, value);
    if (status != std::errc() || end != last || !std::isfinite(value)) return std::nullopt;
    return value;
}

/// Which cell of a line is what, from the header.
struct Columns {
    int time = -1;
    double time_unit = 1;
    int occluded = -1;
    struct Finger {
        std::array<int, 3> axis{-1, -1, -1};
        double unit = 1;
    };
    std::vector<std::string> names;
    std::vector<Finger> fingers;
    size_t count = 0;
};

std::optional<double> unit_of(const std::string& suffix, Quantity quantity) {
    for (const Unit& unit : units(quantity)) {
        if (unit.suffix == suffix) return unit.si;
    }
    return std::nullopt;
}

Columns read_header(const std::string& file, const std::vector<std::string>& cells,
                    Diagnostics& diagnostics) {
    const Place place{file, 1};
    const std::string remedy =
        "The first line names the columns: time_ms, then thumb_x_mm, thumb_y_mm, thumb_z_mm, the "
        "same for each "
        "other finger, and occluded if the tracker tells.";
    Columns columns;
    columns.count = cells.size();
    std::map<std::string, size_t> index_of;
    for (size_t i = 0; i < cells.size(); ++i) {
        const std::string& cell = cells[i];
        const int at = static_cast<int>(i);
        const size_t last = cell.rfind('_');
        const std::string unit = last == std::string::npos ? "" : cell.substr(last + 1);
        const std::string stem = last == std::string::npos ? cell : cell.substr(0, last);
        if (cell == "occluded") {
            columns.occluded = at;
        } else if (const auto time_unit = unit_of(unit, Quantity::time);
                   stem == "time" && time_unit) {
            columns.time = at;
            columns.time_unit = *time_unit;
        } else if (const auto length_unit = unit_of(unit, Quantity::length);
                   length_unit && stem.size() > 2 && stem[stem.size() - 2] == '_' &&
                   stem.back() >= 'x' && stem.back() <= 'z') {
            const std::string finger = stem.substr(0, stem.size() - 2);
            if (!index_of.contains(finger)) {
                index_of[finger] = columns.names.size();
                columns.names.push_back(finger);
                columns.fingers.emplace_back().unit = *length_unit;
            }
            Columns::Finger& f = columns.fingers[index_of[finger]];
            if (f.unit != *length_unit)
                diagnostics.error(place, cell, "has another unit than the finger's other axes",
                                  "Use one unit.");
            f.axis[static_cast<size_t>(stem.back() - 'x')] = at;
        } else {
            diagnostics.error(place, cell, "is not a column of a movement", remedy);
        }
    }
    if (columns.time < 0) diagnostics.error(place, "time_ms", "this column is missing", remedy);
    if (columns.fingers.empty())
        diagnostics.error(place, "thumb_x_mm", "there is no column of a finger", remedy);
    for (size_t f = 0; f < columns.fingers.size(); ++f) {
        for (size_t axis = 0; axis < 3; ++axis) {
            if (columns.fingers[f].axis[axis] >= 0) continue;
            diagnostics.error(place, fmt::format("{}_{}_mm", columns.names[f], "xyz"[axis]),
                              "this column is missing", remedy);
        }
    }
    return columns;
}

Vec3 to_world(const Vec3& p, RecordingAxes axes) {
    return axes == RecordingAxes::y_up ? Vec3(p.x(), -p.z(), p.y()) : p;
}

/// A hand that reaches and grasps moves by centimetres to decimetres.
void check_extent(const Movement& movement, Diagnostics& diagnostics) {
    Vec3 low = Vec3::Constant(std::numeric_limits<double>::infinity());
    Vec3 high = -low;
    for (const Movement::Frame& frame : movement.frames) {
        for (const Vec3& p : frame.p_WH) {
            if (!p.allFinite()) continue;
            low = low.cwiseMin(p);
            high = high.cwiseMax(p);
        }
    }
    const double extent = (high - low).maxCoeff();
    const Place place{movement.file, 1};
    if (extent < 0.005) {
        diagnostics.error(place, "",
                          fmt::format("the fingers move by only {:.3g} mm in all", extent * 1e3),
                          "If the values are in metres, name the columns so: thumb_x_m.");
    } else if (extent > 5) {
        diagnostics.error(place, "", fmt::format("the fingers move by {:.3g} m", extent),
                          "If the values are in millimetres, name the columns so: thumb_x_mm.");
    }
}

}  // namespace

Movement read_movement(const std::string& file, RecordingAxes axes, Diagnostics& diagnostics) {
    Movement movement;
    movement.file = file;
    std::ifstream in(file);
    std::string line;
    if (!in) {
        diagnostics.error({file, 0}, "", "cannot be read", "Check the name and the folder.");
        return movement;
    }
    if (!std::getline(in, line) || line.empty()) {
        diagnostics.error({file, 1}, "", "is empty",
                          "A movement starts with a line of column names, then a line a frame.");
        return movement;
    }
    Diagnostics problems;
    const Columns columns = read_header(file, split(line), problems);
    movement.fingers = columns.names;
    if (problems.has_errors()) {
        diagnostics.add(problems.problems());
        return movement;
    }

    int line_number = 1;
    while (problems.problems().size() < kMostErrors && std::getline(in, line)) {
        ++line_number;
        if (line.empty() || line == "\r") continue;
        const Place place{file, line_number};
        const std::vector<std::string> cells = split(line);
        if (cells.size() != columns.count) {
            problems.error(place, "",
                           fmt::format("has {} values where the first line names {} columns",
                                       cells.size(), columns.count),
                           "Complete the line, or delete it: missing frames are bridged.");
            continue;
        }
        bool readable = true;
        const auto cell = [&](int i, const std::string& name) {
            const std::string& text = cells[static_cast<size_t>(i)];
            if (is_missing(text)) return kNaN;
            if (const auto value = number(text)) return *value;
            problems.error(place, name, fmt::format("'{}' is not a number", text),
                           "Correct it, or delete the line: missing frames are bridged.");
            readable = false;
            return kNaN;
        };
        Movement::Frame frame;
        frame.line = line_number;
        frame.time = cell(columns.time, "time") * columns.time_unit;
        frame.occluded = columns.occluded >= 0 && cell(columns.occluded, "occluded") == 1;
        for (size_t f = 0; f < columns.fingers.size(); ++f) {
            Vec3 p;
            for (size_t axis = 0; axis < 3; ++axis) {
                const std::string name = fmt::format("{}_{}", columns.names[f], "xyz"[axis]);
                p[static_cast<int>(axis)] =
                    cell(columns.fingers[f].axis[axis], name) * columns.fingers[f].unit;
            }
            frame.p_WH.push_back(to_world(p, axes));
        }
        if (!readable) continue;
        if (std::isnan(frame.time)) {
            problems.error(place, "time", "has no time",
                           "Correct it, or delete the line: missing frames are bridged.");
            continue;
        }
        if (!movement.frames.empty() && frame.time <= movement.frames.back().time) {
            problems.error(place, "time",
                           fmt::format("time goes from {:.6g} s back to {:.6g} s",
                                       movement.frames.back().time, frame.time),
                           "Correct it, or delete the line: missing frames are bridged.");
            continue;
        }
        movement.frames.push_back(std::move(frame));
    }
    if (!problems.has_errors() && movement.frames.size() < 10) {
        problems.error({file, line_number}, "",
                       fmt::format("has only {} frames", movement.frames.size()),
                       "A movement needs at least 10.");
    }
    if (!problems.has_errors()) check_extent(movement, problems);
    diagnostics.add(problems.problems());
    return movement;
}

}  // namespace dihaptic::hand
