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
// A lift is dropped if the object stands again without having been carried there: in between no
// digit touched it, or it slid along those that held it throughout by more than half of its height.
//
// Preload lasts from the first touch to the first load onset, loading from the last load onset to
// lift-off, releasing from replacement to the last digit's release.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "analysis/episodes.h"
#include "analysis/grasp_trace.h"
#include "base/unmeasured.h"

namespace dihaptic::analysis {

/// The rule by which a lift's events are found.
enum class EventRule { contact, force };
constexpr auto enum_names(EventRule) {
    return std::array{"contact", "force"};
}

/// The figures of one lift, in SI units; NaN where an event that a figure needs did not happen.
struct Lift {
    int trial = 0;
    int attempt = 0;
    std::string mark;
    EventRule rule = EventRule::force;
    double touch = kUnmeasured, load_onset = kUnmeasured, lift_off = kUnmeasured;
    double replacement = kUnmeasured, release = kUnmeasured;
    double preload = kUnmeasured, loading = kUnmeasured, releasing = kUnmeasured;
    double peak_grip = kUnmeasured, peak_grip_time = kUnmeasured, peak_load = kUnmeasured;
    double peak_grip_rate = kUnmeasured, peak_load_rate = kUnmeasured, lift_off_grip = kUnmeasured;
    double static_grip = kUnmeasured, static_load = kUnmeasured, static_ratio = kUnmeasured;
    double safety_margin = kUnmeasured;
    double grip_load_r = kUnmeasured, grip_load_r_peak = kUnmeasured, grip_load_lag = kUnmeasured;
    double slope = kUnmeasured, offset = kUnmeasured;
    double height = kUnmeasured, overshoot = kUnmeasured, slip = kUnmeasured;
    int slips = 0;
    double first_slip = kUnmeasured;

    template <class Self, class Visitor>
    static void visit(Self& f, Visitor& v) {
        v("trial_num", f.trial, "1", "number in the session, from 1");
        v("attempt", f.attempt, "1", "at the trial, from 1; without a task: the lift's number");
        v("lift", f.mark, "",
          "complete, or what is missing: no touch, not lifted, dropped, no hold, not put down, not "
          "released; paused; place not known, if ticks are missing");
        v("events_by", f.rule, "", "rule by which the times were found: contact or force");
        v("touch", f.touch, "s", "of the first digit, in the session");
        v("load_onset", f.load_onset, "s", "of the first digit");
        v("lift_off", f.lift_off, "s", "when the object left what it stood on");
        v("replacement", f.replacement, "s", "when the object stood again");
        v("release", f.release, "s", "by the last digit");
        v("preload", f.preload, "s", "from touch to load onset");
        v("loading", f.loading, "s", "from the last digit's load onset to lift-off");
        v("releasing", f.releasing, "s", "from replacement to release");
        v("peak_grip", f.peak_grip, "N", "mean of the digits, from touch to lowering");
        v("peak_grip_time", f.peak_grip_time, "s", "from lift-off");
        v("peak_load", f.peak_load, "N", "sum of the digits, from touch to lowering");
        v("peak_grip_rate", f.peak_grip_rate, "N/s", "before lift-off");
        v("peak_load_rate", f.peak_load_rate, "N/s", "before lift-off");
        v("lift_off_grip", f.lift_off_grip, "N", "at lift-off");
        v("static_grip", f.static_grip, "N",
          "mean in the hold: from 600 to 200 ms before lowering");
        v("static_load", f.static_load, "N", "mean in the hold");
        v("static_ratio", f.static_ratio, "1", "static grip over static load");
        v("safety_margin", f.safety_margin, "1",
          "share of the static grip beyond what friction needs");
        v("grip_load_r", f.grip_load_r, "1", "r of the rates of grip and load while loading");
        v("grip_load_r_peak", f.grip_load_r_peak, "1",
          "largest r with the grip shifted by up to 100 ms");
        v("grip_load_lag", f.grip_load_lag, "s", "that shift; positive: grip follows load");
        v("slope", f.slope, "1", "of the line grip = offset + slope load, while loading");
        v("offset", f.offset, "N", "of that line");
        v("height", f.height, "mm", "mean in the hold, above where the object lay");
        v("overshoot", f.overshoot, "mm", "largest height beyond that");
        v("slip", f.slip, "mm", "of the digit that slipped most, from lift-off to lowering");
        v("slips", f.slips, "1", "times that a digit slid faster than 5 mm/s");
        v("first_slip", f.first_slip, "s", "when the first of these began, in the session");
    }

    bool complete() const { return mark == "complete"; }
};

/// Parts of a trace with a lift each: each but the last ends when the object, after it was lifted,
/// has stood untouched for a while; the next begins there, or after a pause in which nothing is
/// held. One part, if nothing was lifted.
std::vector<Range> lifts_in(const GraspTrace& trace, const Vec3& gravity);

/// Finds the lift in the trace of one attempt, in which the object lies at first. `friction`:
/// coefficients of the object with each finger. `rule`: if unset, by contact if the trace has
/// contacts that show when the object stands, otherwise by force.
Lift find_lift(const GraspTrace& trace, const Vec3& gravity, std::span<const double> friction,
               std::optional<EventRule> rule = std::nullopt);

}  // namespace dihaptic::analysis
