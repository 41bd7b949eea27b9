#include "task/file/drive.h"

#include <fmt/format.h>

#include <algorithm>

#include "task/plan/lookup.h"

namespace dihaptic::task {
namespace {

/// Checks that the path is given in exactly one form.
void check_form(const DriveSpec& spec, Diagnostics& diagnostics) {
    const int forms =
        spec.to.has_value() + spec.by.has_value() + !spec.along.empty() + spec.path.has_value();
    const bool turns = spec.axis || spec.angle != 0;
    if (forms > 1 || (forms == 0 && !turns))
        diagnostics.error(
            spec.place, "to",
            forms == 0 ? "gives no destination" : "gives several destinations at once",
            "Give it to_mm, by_mm, angle_deg, 'along' or 'path'.");
    if (turns && (spec.path || !spec.along.empty()))
        diagnostics.error(spec.place, "angle", "cannot be combined with 'along' or 'path'",
                          "Leave it out, or give to_mm or by_mm.");
}

/// Checks that the timing of the path is given exactly once.
void check_times(const DriveSpec& spec, Diagnostics& diagnostics) {
    if (spec.path && spec.duration)
        diagnostics.error(spec.place, "duration", "is already given by the times of the path",
                          "Leave it out.");
    if (!spec.along.empty() && (spec.duration || spec.delay != 0))
        diagnostics.error(spec.place, "duration", "is only for to_mm, by_mm and angle_deg",
                          "Put the timing into the expressions, e.g. with time_in_state.");
    if (!spec.path && spec.along.empty() && !spec.duration)
        diagnostics.error(spec.place, "duration", "is missing", "Add e.g. duration_s: 0.8.");
}

void check_along(const DriveSpec& spec, Diagnostics& diagnostics) {
    if (!spec.along.empty() && spec.along.size() != 3)
        diagnostics.error(spec.place, "along", "must be three expressions, for x, y and z",
                          "Write e.g. along: [0, 0, 10 mm * sin(12 * time_in_state / (1 s))].");
}

}  // namespace

Drive::Drive(const DriveSpec& spec, int body, Quantities& quantities, Diagnostics& diagnostics)
    : body_(body),
      relative_(!spec.to),
      angle_(spec.angle),
      course_{spec.delay, spec.duration.value_or(0), spec.shape} {
    check_form(spec, diagnostics);
    check_times(spec, diagnostics);
    check_along(spec, diagnostics);
    if (spec.axis || spec.angle != 0) axis_ = axis_of(spec.axis, spec.place, "axis", diagnostics);
    if (spec.to || spec.by) way_ = spec.to ? *spec.to : *spec.by;
    if (spec.path && spec.path->check(diagnostics)) path_ = spec.path;
    if (spec.along.size() != 3) return;
    for (const std::string& text : spec.along) {
        along_.push_back(Expression::compile_of(
            Quantity::length, "length", text, quantities, spec.place, "along",
            "Write a length with its unit, e.g. 10 mm * share.", diagnostics));
    }
    if (std::any_of(along_.begin(), along_.end(), [](const auto& e) { return e.empty(); }))
        along_.clear();
}

}  // namespace dihaptic::task
