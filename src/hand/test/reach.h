// A recorded reach without faults, provided as a file that tests can damage.
#pragma once

#include <fmt/format.h>

#include <sstream>

#include "hand/movement.h"
#include "model/minimum_jerk.h"
#include "testing/files.h"

namespace dihaptic::hand {

constexpr double kFrame = 1.0 / 85;

/// Thumb and index finger move 30 cm out while they open to 80 mm and close to 40 mm, then wait,
/// and return.
struct Reach {
    static Vec3 at(int finger, double t) {
        const double there =
            model::minimum_jerk((t - 0.2) / 1.0).share - model::minimum_jerk((t - 2.6) / 0.8).share;
        const double aperture = 0.012 + 0.068 * model::minimum_jerk((t - 0.2) / 0.7).share -
                                0.04 * model::minimum_jerk((t - 1.1) / 0.5).share -
                                0.028 * model::minimum_jerk((t - 2.6) / 0.8).share;
        return Vec3(0.2 - 0.2 * there, 0.1 + 0.25 * there, -0.3 + 0.28 * there) +
               (finger == 0 ? -0.5 : 0.5) * aperture * Vec3(0, 1, 0);
    }
};

/// The reach in CSV format: a header, then one line per frame.
inline std::vector<std::string> reach_lines() {
    std::vector<std::string> lines{
        "time_ms,thumb_x_mm,thumb_y_mm,thumb_z_mm,index_x_mm,index_y_mm,index_z_mm,occluded"};
    for (double t = 0; t < 3.5; t += kFrame) {
        const Vec3 thumb = 1e3 * Reach::at(0, t);
        const Vec3 index = 1e3 * Reach::at(1, t);
        lines.push_back(fmt::format("{:.3f},{:.3f},{:.3f},{:.3f},{:.3f},{:.3f},{:.3f},0", t * 1e3,
                                    thumb.x(), thumb.y(), thumb.z(), index.x(), index.y(),
                                    index.z()));
    }
    return lines;
}

inline std::string join(const std::vector<std::string>& lines) {
    std::string out;
    for (const std::string& line : lines) out += line + "\n";
    return out;
}

inline void set_cell(std::string& line, int column, const std::string& text) {
    size_t at = 0;
    for (int i = 0; i < column; ++i) at = line.find(',', at) + 1;
    line.replace(at, line.find(',', at) - at, text);
}
inline std::string cell(const std::string& line, int column) {
    std::istringstream in(line);
    std::string out;
    for (int i = 0; i <= column; ++i) std::getline(in, out, ',');
    return out;
}

struct Result {
    Movement movement;
    Diagnostics diagnostics;
};
inline Result read(const std::string& text) {
    const testing::TemporaryFolder folder;
    Result result;
    result.movement =
        read_movement(folder.write("m.csv", text), RecordingAxes::world, result.diagnostics);
    return result;
}

}  // namespace dihaptic::hand
