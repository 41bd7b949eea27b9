// Finds the events of a grip-lift and computes its figures: reach, touch, preload, loading,
// lift-off, hold, replacement, release (Johansson and Westling 1984; rules from forces: Luciw,
// Jarocka and Edin 2014). Grip force GF is the mean of the digits' normal forces, load force LF the
// sum of their tangential forces against gravity; rates are derivatives of cubics over 62 ms.
//
// Events are found by contact, if the trace has contacts of the object with what it stands on:
//
// touch         of a digit: the first sample from which it presses the object until lift-off;
//               a gap of less than 50 ms is a bounce
// load onset    of a digit: after the last sample before lift-off in which it carried no more than
//               2 % of what it carries at lift-off
// lift-off      after the last sample, before half of the height, in which the object stood
// replacement   the first sample, after half of the height, in which the object stands again
// release       of a digit: after the last sample in which it pressed, with bounces as for touch
//
// and otherwise by force, by the rules of the WAY-EEG-GAL data set, which need no contacts and are
// late or early by tens of milliseconds, since they smooth over 62 ms and wait for thresholds:
//
// touch         from a quarter of the digit's largest force back to where the force's rate is no
//               more than mean + 4 SD of the trial's first 100 ms; only the force before lift-off
//               counts if the largest came from something later
// load onset    from 0.2 N back to where the load's rate began to grow; none for lighter objects
// lift-off      from half of the height back to where the object rose by 1 cm/s or less
// replacement   from the last time at half of the height on to where it sinks by 2 cm/s or less
// release       after a quarter of the digit's force at replacement, by the threshold of touch
//
// hold          from 600 to 200 ms before the object is lowered, by either rule
//
// A pause takes the forces away, and hands close: a lift with a pause is marked, and has no
// figures.
//
// Preload lasts from the first touch to the first load onset, loading from the last load onset to
// lift-off, releasing from replacement to the last digit's release.
#pragma once

#include <array>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "analysis/episodes.h"
#include "analysis/grasp_trace.h"
#include "base/table.h"

namespace dihaptic::analysis {

/// The rule by which a lift's events are found.
enum class EventRule { contact, force };
constexpr auto enum_names(EventRule) {
    return std::array{"contact", "force"};
}

/// The figures of one lift; NaN where an event that a figure needs did not happen.
struct Lift {
    static constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

    int trial = 0;
    int attempt = 0;
    /// complete, or what is missing: no touch, not lifted, dropped, no hold, not put down, not
    /// released; or paused; or place not known, if ticks are missing.
    std::string mark;
    EventRule rule = EventRule::force;
    double touch = kNone;  ///< by the first digit; these are times in the session [s]
    double load_onset = kNone;
    double lift_off = kNone;
    double replacement = kNone;
    double release = kNone;  ///< by the last digit

    double preload = kNone;  ///< these are durations [s]
    double loading = kNone;
    double releasing = kNone;
    double peak_grip = kNone;       ///< between touch and the object's lowering [N]
    double peak_grip_time = kNone;  ///< from lift-off [s]
    double peak_load = kNone;       ///< [N]
    double peak_grip_rate = kNone;  ///< between touch and lift-off [N/s]
    double peak_load_rate = kNone;  ///< [N/s]
    double lift_off_grip = kNone;   ///< [N]
    double static_grip = kNone;     ///< mean in the hold [N]
    double static_load = kNone;
    double static_ratio = kNone;   ///< static grip over static load
    double safety_margin = kNone;  ///< share of the static grip beyond what friction needs
    double coupling = kNone;       ///< r of the rates of grip and load from load onset to lift-off
    double coupling_peak = kNone;  ///< largest r with the grip shifted by up to 100 ms
    double coupling_lag = kNone;   ///< that shift: positive where grip follows load [s]
    double slope = kNone;          ///< of the line grip = offset + slope load, while loading
    double offset = kNone;         ///< of that line [N]
    double height = kNone;         ///< mean in the hold, above where the object lay [m]
    double overshoot = kNone;      ///< largest height beyond that [m]
    double slip = kNone;           ///< a digit's largest on the object, lift-off to lowering [m]
    int slips = 0;                 ///< times that a digit slid on the object faster than 5 mm/s

    bool complete() const { return mark == "complete"; }
};

/// Finds the lift in the trace of one attempt, in which the object lies at first. `friction`:
/// coefficients of the object with each finger. `rule`: if unset, by contact if the trace has
/// contacts that show when the object stands, otherwise by force.
Lift find_lift(const GraspTrace& trace, const Vec3& gravity, std::span<const double> friction,
               std::optional<EventRule> rule = std::nullopt);

Table lift_table(std::span<const Lift> lifts);

}  // namespace dihaptic::analysis
