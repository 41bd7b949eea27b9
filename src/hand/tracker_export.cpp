#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <map>

#include "base/number.h"
#include "base/text_file.h"
#include "hand/columns.h"

namespace dihaptic::hand {
namespace {

using Cells = std::vector<std::string>;

std::string cell(const Cells& cells, size_t i) {
    return i < cells.size() ? cells[i] : "";
}

/// Extracts the marker name: "hand:thumb" is the marker "thumb" of the asset "hand".
std::string marker_of(const std::string& name) {
    return name.substr(name.rfind(':') + 1);
}

Error unreadable(const GivenTable& table, const std::string& what) {
    return {table.place(), "", what,
            "Export it again with its header, or name the columns in one line: time_s, thumb_x_mm, "
            "thumb_y_mm, thumb_z_mm, ..."};
}

Cells next_line(GivenTable& table) {
    if (auto cells = table.next()) return *cells;
    throw unreadable(table, "ends within its header");
}

double unit_of(const std::string& name, const GivenTable& table) {
    static const std::map<std::string, double> kUnits{
        {"mm", 1e-3},          {"cm", 1e-2},          {"m", 1},
        {"Millimeters", 1e-3}, {"Centimeters", 1e-2}, {"Meters", 1}};
    const auto found = kUnits.find(name);
    if (found != kUnits.end()) return found->second;
    throw unreadable(table, fmt::format("the unit of its positions is '{}', not metres, "
                                        "centimetres or millimetres",
                                        shortened(name)));
}

double period_of(const std::string& rate, GivenTable& table) {
    const auto frames = table.number(rate);
    if (frames && *frames > 0) return 1 / *frames;
    throw unreadable(table, fmt::format("its frame rate is '{}'", shortened(rate)));
}

void add_marker(Columns& columns, const std::string& name, size_t x, double unit) {
    const int at = static_cast<int>(x);
    columns.fingers.push_back({name, "mm", unit, {at, at + 1, at + 2}});
}

bool has(const Columns& columns, const std::string& name) {
    return std::any_of(columns.fingers.begin(), columns.fingers.end(),
                       [&](const Columns::Finger& finger) { return finger.name == name; });
}

/// Adds markers by name; each name may occur only once.
void add_once(Columns& columns, const std::string& name, size_t x, double unit,
              const GivenTable& table) {
    if (has(columns, name))
        throw unreadable(table, fmt::format("two markers have the name {}", shortened(name)));
    add_marker(columns, name, x, unit);
}

/// Returns the line with this label in the header of a Motive file. Older versions omit the label;
/// the line is then found by its distance from the end of the header.
Cells line_of(const std::vector<Cells>& head, const char* label, size_t from_end) {
    for (const Cells& cells : head) {
        if (cell(cells, 1) == label) return cells;
    }
    return head.size() >= from_end ? head[head.size() - from_end] : Cells();
}

/// Reads a Motive header: settings in one line; then lines with each column's type, name,
/// identifier and property; then Frame, Time (Seconds) and the axes. Besides markers, there are
/// rigid bodies and the expected positions of their markers. If an expected marker has the same
/// name as a measured one, the measured marker is used.
Columns read_motive(const Cells& settings, GivenTable& table) {
    const auto key = std::find(settings.begin(), settings.end(), "Length Units");
    const double unit = unit_of(key < settings.end() - 1 ? key[1] : "", table);
    std::vector<Cells> head;
    Cells axes = next_line(table);
    for (; axes[0] != "Frame"; axes = next_line(table)) head.push_back(axes);
    const Cells types = line_of(head, "Type", 4);
    const Cells names = line_of(head, "Name", 3);
    const Cells properties = line_of(head, "Property", 1);
    Columns columns;
    columns.time = 1;
    for (const bool measured : {true, false}) {
        for (size_t i = 2; i + 2 < axes.size(); ++i) {
            const std::string name = marker_of(cell(names, i));
            const bool position = cell(properties, i) == "Position" && axes[i] == "X";
            if (!position || name.empty() || (cell(types, i) == "Marker") != measured) continue;
            if (measured) add_once(columns, name, i, unit, table);
            if (!has(columns, name)) add_marker(columns, name, i, unit);
        }
    }
    return columns;
}

/// Reads a Nexus header: the word Trajectories; frames per second; each marker's name above its x;
/// Frame, Sub Frame and the axes; units.
Columns read_nexus(GivenTable& table) {
    Columns columns;
    columns.time = 0;
    columns.time_unit = period_of(next_line(table)[0], table);
    const Cells names = next_line(table);
    const Cells axes = next_line(table);
    const Cells units = next_line(table);
    if (axes[0] != "Frame")
        throw unreadable(table, "the fourth line of its header does not start with 'Frame'");
    for (size_t i = 2; i + 2 < axes.size(); ++i) {
        if (cell(names, i).empty() || axes[i] != "X") continue;
        add_once(columns, marker_of(names[i]), i, unit_of(cell(units, i), table), table);
    }
    return columns;
}

/// Reads the lines that contain Qualisys' column names or marker types. Returns whether a frame
/// number and a time precede the markers.
bool take_column_names(GivenTable& table) {
    bool named = false;
    for (auto cells = table.peek(); cells; cells = table.peek()) {
        const std::string& first = cells->front();
        const bool frame = first == "Frame";
        if (!frame && first != "TRAJECTORY_TYPES" && !first.ends_with(" X")) break;
        named = named || frame;
        table.next();
    }
    return named;
}

/// Reads a Qualisys header: one line per setting, the last of which is MARKER_NAMES, optionally
/// followed by TRAJECTORY_TYPES; optionally a line that names the columns. The data has x, y, z of
/// each marker in mm, optionally after a frame number and a time.
Columns read_qualisys(const Cells& first, GivenTable& table) {
    Columns columns;
    double period = 0;
    Cells cells = first;
    for (; cells[0] != "MARKER_NAMES"; cells = next_line(table)) {
        if (cells[0] == "FREQUENCY") period = period_of(cell(cells, 1), table);
    }
    if (period == 0) throw unreadable(table, "its header does not contain FREQUENCY");
    const Cells markers(cells.begin() + 1, std::find(cells.begin() + 1, cells.end(), ""));
    const bool named = take_column_names(table);
    const auto row = table.peek();
    const bool timed = named || (row && row->size() >= 3 * markers.size() + 2);
    columns.time = timed ? 1 : -1;
    columns.time_unit = timed ? 1 : period;
    size_t x = timed ? 2 : 0;
    for (const std::string& marker : markers) {
        add_once(columns, marker_of(marker), x, 1e-3, table);
        x += 3;
    }
    return columns;
}

/// Sets the names for messages, in the style of our own file format.
void name_keys(Columns& columns) {
    for (const Columns::Finger& finger : columns.fingers) {
        for (size_t k = 0; k < 3; ++k) {
            const auto at = static_cast<size_t>(finger.axis[k]);
            if (columns.keys.size() <= at) columns.keys.resize(at + 1);
            columns.keys[at] = fmt::format("{}_{}_mm", finger.name, "xyz"[k]);
        }
    }
    if (columns.time >= 0) columns.keys[static_cast<size_t>(columns.time)] = "time_s";
}

}  // namespace

std::optional<Columns> read_export(const Cells& first, GivenTable& table) {
    Columns columns;
    if (first[0] == "Format Version") {
        columns = read_motive(first, table);
    } else if (first[0] == "Trajectories") {
        columns = read_nexus(table);
    } else if (first[0] == "NO_OF_FRAMES" || first[0] == "FILE_VERSION") {
        columns = read_qualisys(first, table);
    } else {
        return std::nullopt;
    }
    columns.exported = true;
    if (columns.fingers.empty()) throw unreadable(table, "its header names no marker");
    name_keys(columns);
    return columns;
}

}  // namespace dihaptic::hand
