// Finds the events of a grip-lift and computes its figures: reach, touch, preload, loading,
// lift-off, hold, replacement, release (Johansson and Westling 1984; rules from forces: Luciw,
// Jarocka and Edin 2014). Grip force GF is the mean of the digits' normal forces, load force LF the
// sum of their tangential forces against gravity; rates are derivatives of cubics over 62 ms.
//
// Events are found by contact if the trace has contacts between the object and its support:
//
// touch         of a digit: the first sample from which it presses the object until lift-off;
//               a gap of less than 50 ms is a bounce
// load onset    of a digit: after the last sample before lift-off in which it carried no more than
//               2 % of what it carries at lift-off
// lift-off      after the last sample, before half of the height, in which the object stood
// replacement   the first sample, after half of the height, in which the object stands again
// release       of a digit: after the last sample in which it pressed, with bounces as for touch
//
// Otherwise events are found by force, using the rules of the WAY-EEG-GAL data set. These rules
// need no contacts, but may be late or early by tens of milliseconds, since they smooth over 62 ms
// and rely on thresholds:
//
// touch         from a quarter of the digit's largest force back to where the force's rate is no
//               more than mean + 4 SD of the trial's first 100 ms; only the force before lift-off
//               is used if the touch would otherwise come after it
// load onset    from 0.2 N back to where the load's rate began to grow; none for lighter objects
// lift-off      from half of the height back to where the object rose by 1 cm/s or less
// replacement   from the last time at half of the height on to where it sinks by 2 cm/s or less
// release       after a quarter of the digit's force at replacement, by the threshold of touch
//
// hold          from 600 to 200 ms before the object is lowered, by either rule
//
// During a pause no forces act, and the hands close. A lift that contains a pause is marked as
// such, and has no figures.
//
// A lift counts as dropped if the object stands again without having been carried there: for part
// of the time no digit touched it, or it slid by more than half of its height along the digits that
// held it throughout.
//
// Preload lasts from the first touch to the first load onset, loading from the last load onset to
// lift-off, releasing from replacement to the last digit's release.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "analysis/episodes.h"
#include "analysis/grasp_trace.h"
#include "rows/lift_row.h"

namespace dihaptic::analysis {

/// Splits the trace into parts with one lift each. Each part except the last ends when the object,
/// having been lifted, has stood untouched for a while. The next part begins there, or after a
/// pause during which nothing is held. Returns a single part if nothing was lifted.
std::vector<Range> lifts_in(const GraspTrace& trace, const Vec3& gravity);

/// Finds the lift in the trace of one attempt. The object must be at rest on its support at first.
/// `friction`: friction coefficients between the object and each finger. `rule`: if unset, events
/// are found by contact if the trace has contacts that show when the object stands, otherwise by
/// force.
rows::LiftRow find_lift(const GraspTrace& trace, const Vec3& gravity,
                        std::span<const double> friction,
                        std::optional<rows::EventRule> rule = std::nullopt);

}  // namespace dihaptic::analysis
