#include "hand/movement_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/unmeasured.h"

namespace dihaptic::hand {
namespace {

std::string unit_of(const std::string& column) {
    return column.substr(column.rfind('_') + 1);
}

/// Largest extent of a finger's movement along any axis, ignoring the few most extreme positions,
/// which may be wild.
double typical_extent(const Movement& movement, size_t finger) {
    double extent = 0;
    for (int axis = 0; axis < 3; ++axis) {
        std::vector<double> values;
        for (const Movement::Frame& frame : movement.frames) {
            if (frame.p_WH[finger].allFinite()) values.push_back(frame.p_WH[finger][axis]);
        }
        if (values.empty()) return kUnmeasured;
        std::sort(values.begin(), values.end());
        const size_t trim = std::min(values.size() / 4, 5 + values.size() / 100);
        extent = std::max(extent, values[values.size() - 1 - trim] - values[trim]);
    }
    return extent;
}

/// Checks the movement's frame rate. If no tracker has such a rate, reports an error and returns
/// false.
bool check_rate(const Movement& movement, Diagnostics& problems) {
    const std::string& key = movement.time_column;
    const std::string unit = unit_of(key);
    const double step = movement.frame_time();
    if (step > 1 / kSlowestTracker) {
        problems.error({movement.file, 1}, key,
                       fmt::format("the lines are {:.6g} s apart, but at least {:g} frames a "
                                   "second are needed",
                                   step, kSlowestTracker),
                       unit == "s" ? "If the times are in milliseconds, name the column time_ms."
                                   : "Record at a higher rate.");
        return false;
    }
    if (step > 0 && step < 1 / kFastestTracker) {
        problems.error({movement.file, 1}, key,
                       fmt::format("the lines are {:.3g} s apart: more than {:g} frames a second",
                                   step, kFastestTracker),
                       unit == "s" ? "Check the times' unit, or export at a lower rate."
                                   : "If the times are in seconds, name the column time_s.");
        return false;
    }
    return true;
}

/// Checks that the time in each line is later than in the previous line, but not by too much.
void check_steps(const Movement& movement, Diagnostics& problems) {
    const auto& frames = movement.frames;
    const std::string& key = movement.time_column;
    const std::string unit = unit_of(key);
    const double to_unit = unit == "ms" ? 1e3 : 1;
    const auto shown = [&](const Movement::Frame& frame) {
        return fmt::format("{:.9g} {}", frame.time * to_unit, unit);
    };
    for (size_t i = 1; i < frames.size() && problems.problems().size() < kMostErrors; ++i) {
        const Movement::Frame& a = frames[i - 1];
        const Movement::Frame& b = frames[i];
        const Place place{movement.file, b.line};
        if (b.time == a.time) {
            problems.error(place, key, fmt::format("the same time twice, {}", shown(b)),
                           kLineRemedy);
        } else if (b.time < a.time) {
            problems.error(place, key,
                           fmt::format("time goes from {} back to {}", shown(a), shown(b)),
                           kLineRemedy);
        } else if (b.time - a.time > kLongestGap) {
            problems.error(
                place, key,
                fmt::format("time jumps from {} (line {}) to {}: a gap may last {:g} s at most",
                            shown(a), a.line, shown(b), kLongestGap),
                "Correct the wrong time, or delete its line: missing frames are "
                "bridged.");
            return;  // the lines that follow would only repeat this error
        }
    }
}

}  // namespace

void check_times(const Movement& movement, Diagnostics& problems) {
    const auto& frames = movement.frames;
    if (frames.size() < 2 || !check_rate(movement, problems)) return;
    check_steps(movement, problems);
    const double duration = frames.back().time - frames.front().time;
    if (problems.has_errors() || duration <= kLongestMovement) return;
    problems.error({movement.file, frames.back().line}, movement.time_column,
                   fmt::format("the recording lasts {:.0f} s, but at most {:.0f} s are allowed",
                               duration, kLongestMovement),
                   "Cut it into movements, one file each.");
}

void check_plausible(const Movement& movement, Diagnostics& problems) {
    constexpr double kLeast = 0.005;   // [m]
    constexpr double kUnusual = 0.06;  // [m]
    constexpr double kMost = 2;        // [m]
    const Place place{movement.file, 1};
    double most = 0;
    for (size_t f = 0; f < movement.fingers.size(); ++f) {
        const std::string& name = movement.fingers[f];
        const std::string unit = unit_of(movement.columns[f][0]);
        const double extent = typical_extent(movement, f);
        most = std::max(most, extent);
        if (std::isnan(extent)) {
            problems.error(place, name, "was never seen: it has no position in any line",
                           "Record this movement again, or delete the finger's columns.");
        } else if (extent == 0) {
            problems.error(place, name, "never moves: its marker was frozen throughout",
                           "Record this movement again, or delete the finger's columns.");
        } else if (extent < kLeast) {
            problems.error(
                place, name, fmt::format("moves by only {:.3g} mm in total", extent * 1e3),
                unit == "m" ? "Was its marker tracked? Record this movement again."
                            : fmt::format("If the values are in metres, name the columns "
                                          "{}_x_m.",
                                          name));
        } else if (extent > kMost) {
            problems.error(place, name, fmt::format("moves by {:.3g} m", extent),
                           unit == "mm" ? "Check the values, and their unit."
                                        : fmt::format("If the values are in millimetres, name the "
                                                      "columns {}_x_mm.",
                                                      name));
        }
        for (size_t g = 0; g < f; ++g) {
            const auto& frames = movement.frames;
            const auto same = std::count_if(
                frames.begin(), frames.end(),
                [&](const Movement::Frame& frame) { return frame.p_WH[f] == frame.p_WH[g]; });
            if (same <= static_cast<std::ptrdiff_t>(frames.size() / 2)) continue;
            problems.error(place, name,
                           fmt::format("coincides with {} in {} of {} lines", movement.fingers[g],
                                       same, frames.size()),
                           "Give each finger the columns of its own marker.");
        }
    }
    if (!problems.has_errors() && most < kUnusual) {
        problems.warning(place, "",
                         fmt::format("the fingers move by only {:.3g} mm in total", most * 1e3),
                         "Check the unit in the columns' names.");
    }
}

}  // namespace dihaptic::hand
