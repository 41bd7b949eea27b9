#include "hand/movement.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <set>
#include <string_view>

#include "base/checksum.h"
#include "base/plural.h"
#include "base/statistics.h"
#include "base/text_file.h"
#include "base/unit.h"
#include "base/unmeasured.h"
#include "hand/columns.h"
#include "hand/movement_check.h"

namespace dihaptic::hand {
namespace {

/// Describes the number of items in a list, e.g. "3 frames".
std::string counted_of(const auto& list, const std::string& noun) {
    return counted(static_cast<int64_t>(list.size()), noun);
}

bool is_missing(const std::string& cell) {
    std::string lower;
    for (const char c : cell)
        lower += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    return lower.empty() || lower == "nan" || lower == "na" || lower == "null";
}

std::optional<double> unit_of(const std::string& suffix, Quantity quantity) {
    for (const Unit& unit : units(quantity)) {
        if (unit.suffix == suffix) return unit.si;
    }
    return std::nullopt;
}

constexpr const char* kHeaderRemedy =
    "The first line names the columns: time_ms, then thumb_x_mm, thumb_y_mm, thumb_z_mm, the same "
    "for each other finger, and occluded if the tracker reports it.";

/// The information contained in a column name.
struct Heading {
    enum class Kind { unknown, occluded, time, position };
    Kind kind = Kind::unknown;
    std::string stem;       ///< the name without the unit, e.g. "thumb_x"
    std::string unit_name;  ///< "" if the name does not include a unit
    double unit = 1;
};

bool names_axis(const std::string& stem) {
    return stem.size() > 2 && stem[stem.size() - 2] == '_' && stem.back() >= 'x' &&
           stem.back() <= 'z';
}

Heading heading_of(const std::string& key) {
    Heading out;
    const size_t last = key.rfind('_');
    out.stem = key.substr(0, last);
    if (last != std::string::npos) out.unit_name = key.substr(last + 1);
    const auto time_unit = unit_of(out.unit_name, Quantity::time);
    const auto length_unit = unit_of(out.unit_name, Quantity::length);
    if (key == "occluded") {
        out.kind = Heading::Kind::occluded;
    } else if (out.stem == "time" && time_unit) {
        out.kind = Heading::Kind::time;
        out.unit = *time_unit;
    } else if (names_axis(out.stem) && length_unit) {
        out.kind = Heading::Kind::position;
        out.unit = *length_unit;
    }
    return out;
}

/// Adds a column that contains a finger's position along one axis.
void add_position(Columns& columns, const Heading& heading, int column, const Place& place,
                  Diagnostics& diagnostics) {
    const std::string name = heading.stem.substr(0, heading.stem.size() - 2);
    auto finger = std::find_if(columns.fingers.begin(), columns.fingers.end(),
                               [&](const auto& f) { return f.name == name; });
    if (finger == columns.fingers.end()) {
        columns.fingers.push_back({name, heading.unit_name, heading.unit});
        finger = columns.fingers.end() - 1;
    }
    if (finger->unit_name != heading.unit_name) {
        diagnostics.error(place, columns.key(column),
                          "has a unit other than that of the finger's other axes", "Use one unit.");
    }
    finger->axis[static_cast<size_t>(heading.stem.back() - 'x')] = column;
}

void check_complete(const Columns& columns, const Place& place, Diagnostics& diagnostics) {
    if (columns.time < 0)
        diagnostics.error(place, "time_ms", "this column is missing", kHeaderRemedy);
    if (columns.fingers.empty())
        diagnostics.error(place, "thumb_x_mm", "no column holds a finger's position",
                          kHeaderRemedy);
    for (const Columns::Finger& finger : columns.fingers) {
        for (size_t axis = 0; axis < 3; ++axis) {
            if (finger.axis[axis] >= 0) continue;
            diagnostics.error(place,
                              fmt::format("{}_{}_{}", finger.name, "xyz"[axis], finger.unit_name),
                              "this column is missing", kHeaderRemedy);
        }
    }
}

Columns read_header(const Place& place, std::vector<std::string> header, Diagnostics& diagnostics) {
    if (header[0].starts_with('#'))
        throw Error(place, "", "starts with a comment (#), not with the columns' names",
                    "Delete this line.");
    Columns columns;
    columns.keys = std::move(header);
    std::set<std::string> seen;
    std::vector<std::string> unknown;
    for (size_t i = 0; i < columns.keys.size(); ++i) {
        const std::string& key = columns.keys[i];
        const int at = static_cast<int>(i);
        const Heading heading = heading_of(key);
        if (heading.kind == Heading::Kind::unknown) {
            unknown.push_back(key);
        } else if (!seen.insert(heading.stem).second) {
            diagnostics.error(place, key, fmt::format("column {} repeats an earlier one", i + 1),
                              "Keep one of the two.");
        } else if (heading.kind == Heading::Kind::occluded) {
            columns.occluded = at;
        } else if (heading.kind == Heading::Kind::time) {
            columns.time = at;
            columns.time_unit = heading.unit;
        } else {
            add_position(columns, heading, at, place, diagnostics);
        }
    }
    if (unknown.size() == columns.keys.size()) {
        throw Error(place, "", "the first line names no column of a movement", kHeaderRemedy);
    }
    for (const std::string& key : unknown) {
        diagnostics.error(place, shortened(key),
                          key.empty() ? "a column has no name" : "is not a column of a movement",
                          kHeaderRemedy);
    }
    // a repeated column was probably meant to be the missing one: report only one of the two
    if (!diagnostics.has_errors()) check_complete(columns, place, diagnostics);
    return columns;
}

Vec3 to_world(const Vec3& p, RecordingAxes axes) {
    return axes == RecordingAxes::y_up ? Vec3(p.x(), -p.z(), p.y()) : p;
}

/// Reads the cells of a line into a frame. If they are not valid, reports an error and returns
/// false.
bool read_frame(const Columns& columns, const std::vector<std::string>& cells, RecordingAxes axes,
                GivenTable& table, Movement::Frame& frame, Diagnostics& problems) {
    bool readable = true;
    const Place place = table.place();
    const auto cell = [&](int i) {
        const std::string& text = cells[static_cast<size_t>(i)];
        if (is_missing(text)) return kUnmeasured;
        if (const auto value = table.number(text)) return *value;
        problems.error(place, columns.key(i), fmt::format("'{}' is not a number", shortened(text)),
                       kLineRemedy);
        readable = false;
        return kUnmeasured;
    };
    frame.line = place.line;
    if (columns.time >= 0) frame.time = cell(columns.time) * columns.time_unit;
    if (readable && std::isnan(frame.time)) {
        problems.error(place, columns.key(columns.time), "has no time", kLineRemedy);
        return false;
    }
    if (columns.occluded >= 0) {
        const double occluded = cell(columns.occluded);
        if (!std::isnan(occluded) && occluded != 0 && occluded != 1) {
            problems.error(place, "occluded",
                           fmt::format("must be 0 or 1, but is {:.6g}", occluded),
                           "Write 1 if the tracker had lost a marker, otherwise 0.");
            readable = false;
        }
        frame.occluded = occluded == 1;
    }
    for (const Columns::Finger& finger : columns.fingers) {
        Vec3 p;
        for (size_t axis = 0; axis < 3; ++axis)
            p[static_cast<int>(axis)] = cell(finger.axis[axis]) * finger.unit;
        frame.p_WH.push_back(to_world(p, axes));
    }
    return readable;
}

/// Sets the names of the movement's fingers, and of their columns by world axis.
void name_columns(Movement& movement, const Columns& columns, RecordingAxes axes) {
    movement.time_column = columns.time < 0 ? "time_s" : columns.key(columns.time);
    for (const Columns::Finger& finger : columns.fingers) {
        movement.fingers.push_back(finger.name);
        std::array<std::string, 3> keys;
        for (size_t axis = 0; axis < 3; ++axis) keys[axis] = columns.key(finger.axis[axis]);
        if (axes == RecordingAxes::y_up) std::swap(keys[1], keys[2]);
        movement.columns.push_back(keys);
    }
}

/// Checks whether a line has the right number of cells, and reports an error if not. Trackers'
/// programs may add empty cells at the end of a line.
bool check_count(const Columns& columns, const std::vector<std::string>& cells,
                 const GivenTable& table, Diagnostics& problems) {
    const size_t wanted = columns.keys.size();
    const bool enough = columns.exported ? cells.size() >= wanted : cells.size() == wanted;
    if (enough) return true;
    const bool commas = table.separator() == ',' && cells.size() + 1 >= 2 * wanted;
    problems.error(table.place(), "",
                   fmt::format("has {}, but the first line names {}", counted_of(cells, "value"),
                               counted_of(columns.keys, "column")),
                   commas ? "Do its numbers have decimal commas? Export them with points, or with "
                            "semicolons between the values."
                          : "Complete the line, or delete it: missing frames are bridged.");
    return false;
}

/// Reads the lines below the header.
void read_frames(const Columns& columns, GivenTable& table, RecordingAxes axes, Movement& movement,
                 Diagnostics& problems) {
    while (problems.problems().size() < kMostErrors) {
        const auto cells = table.next();
        // another section of the file may follow, such as force-plate data
        if (!cells || (columns.exported && table.after_gap() && !movement.frames.empty())) return;
        if (!check_count(columns, *cells, table, problems)) continue;
        Movement::Frame frame;
        frame.time = static_cast<double>(movement.frames.size()) * columns.time_unit;
        if (read_frame(columns, *cells, axes, table, frame, problems))
            movement.frames.push_back(std::move(frame));
    }
}

/// Returns the position in a text where the movement starts: in a Nexus export, force-plate data
/// may precede it.
size_t begin_of(std::string_view text) {
    for (const std::string_view line : {"\nTrajectories\n", "\nTrajectories\r", "\nTrajectories,",
                                        "\nTrajectories;", "\nTrajectories\t"}) {
        if (const size_t at = text.find(line); at != std::string_view::npos) return at + 1;
    }
    return 0;
}

/// If the fingers are known, removes those markers of an export that are not fingers, with a
/// warning.
void choose_markers(Columns& columns, const std::vector<std::string>& fingers, const Place& place,
                    Diagnostics& problems) {
    if (fingers.empty()) return;
    std::vector<std::string> others;
    for (const Columns::Finger& marker : columns.fingers) {
        if (std::find(fingers.begin(), fingers.end(), marker.name) == fingers.end())
            others.push_back(marker.name);
    }
    if (others.empty()) return;
    const std::string names = shortened(fmt::format("{}", fmt::join(others, ", ")));
    const std::string wanted = fmt::format("{}", fmt::join(fingers, ", "));
    if (others.size() == columns.fingers.size()) {
        problems.error(
            place, names, "are the markers, but no finger of the scene has any of these names",
            fmt::format("Give the markers the names of the scene's fingers: {}.", wanted));
        return;
    }
    problems.warning(place, names,
                     fmt::format("{} left out: no finger of the scene has such a name",
                                 others.size() == 1 ? "is" : "are"),
                     fmt::format("The scene has {}.", wanted));
    std::erase_if(columns.fingers, [&](const Columns::Finger& marker) {
        return std::find(others.begin(), others.end(), marker.name) != others.end();
    });
}

void read_lines(const std::string& text, RecordingAxes axes, const std::vector<std::string>& wanted,
                Movement& movement, Diagnostics& problems) {
    GivenTable table(text, movement.file, begin_of(text));
    auto first = table.next();
    if (!first)
        throw Error({movement.file, 1}, "", "is empty",
                    "A movement has a line of column names, then one line per frame.");
    auto found = read_export(*first, table);
    if (found) choose_markers(*found, wanted, table.place(), problems);
    const Columns columns =
        found ? *found : read_header(table.place(), std::move(*first), problems);
    if (problems.has_errors()) return;
    name_columns(movement, columns, axes);
    read_frames(columns, table, axes, movement, problems);
    table.tell_commas(problems);
    check_times(movement, problems);
    if (problems.has_errors()) return;
    if (movement.frames.size() < 10) {
        problems.error(table.place(), "",
                       fmt::format("has only {}", counted_of(movement.frames, "frame")),
                       "A movement needs at least 10.");
        return;
    }
    check_plausible(movement, problems);
}

}  // namespace

Movement read_movement(const std::string& file, RecordingAxes axes, Diagnostics& diagnostics,
                       const std::vector<std::string>& fingers) {
    Movement movement;
    movement.file = file;
    Diagnostics problems;
    try {
        const std::string text = read_text_file(file);
        movement.checksum = checksum_of(text);
        read_lines(text, axes, fingers, movement, problems);
    } catch (const Error& e) {
        problems.add(e.problems());
    }
    diagnostics.add(problems.problems());
    return movement;
}

void choose_fingers(Movement& movement, const std::vector<std::string>& fingers,
                    Diagnostics& diagnostics) {
    const Place place{movement.file, 1};
    std::vector<size_t> chosen;
    for (const std::string& finger : fingers) {
        const auto found = std::find(movement.fingers.begin(), movement.fingers.end(), finger);
        if (found == movement.fingers.end()) {
            diagnostics.error(place, finger,
                              fmt::format("the movement has no such finger; it has {}",
                                          fmt::join(movement.fingers, ", ")),
                              "Give the columns the names of the scene's fingers.");
        } else {
            chosen.push_back(static_cast<size_t>(found - movement.fingers.begin()));
        }
    }
    if (chosen.size() < fingers.size()) return;
    for (const std::string& finger : movement.fingers) {
        if (std::find(fingers.begin(), fingers.end(), finger) == fingers.end()) {
            diagnostics.warning(place, finger, "is not a finger of the scene, and is left out",
                                fmt::format("The scene has {}.", fmt::join(fingers, ", ")));
        }
    }
    const auto pick = [&](auto& list) {
        auto picked = list;
        picked.clear();
        for (const size_t f : chosen) picked.push_back(list[f]);
        list = std::move(picked);
    };
    pick(movement.fingers);
    pick(movement.columns);
    for (Movement::Frame& frame : movement.frames) pick(frame.p_WH);
}

double Movement::frame_time() const {
    std::vector<double> steps;
    for (size_t i = 1; i < frames.size(); ++i) steps.push_back(frames[i].time - frames[i - 1].time);
    return quantile(std::move(steps), 0.5);
}

}  // namespace dihaptic::hand
