// A row of lifts.csv. analysis/lifts.h describes how a lift's events are found.
#pragma once

#include <array>
#include <string>

#include "base/unmeasured.h"
#include "rows/row_file.h"

namespace dihaptic::rows {

/// The rule by which the events of a lift are found.
enum class EventRule { contact, force };
constexpr auto enum_names(EventRule) {
    return std::array{"contact", "force"};
}

/// The figures of one lift, in SI units. A figure is NaN if an event on which it depends did not
/// occur.
struct LiftRow {
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
        v("attempt", f.attempt, "1",
          "attempt at the trial, from 1; without a task: the lift's number");
        v("lift", f.mark, "",
          "complete, or the missing event: no touch, not lifted, dropped, no hold, not put down, "
          "not released; paused; place not known, if ticks are missing");
        v("events_by", f.rule, "", "rule by which the times were found: contact or force");
        v("touch", f.touch, "s", "time of the first digit's touch, from the session's start");
        v("load_onset", f.load_onset, "s", "load onset of the first digit");
        v("lift_off", f.lift_off, "s", "when the object left its support");
        v("replacement", f.replacement, "s", "when the object stood on its support again");
        v("release", f.release, "s", "release by the last digit");
        v("preload", f.preload, "s", "time from touch to load onset");
        v("loading", f.loading, "s", "time from the last digit's load onset to lift-off");
        v("releasing", f.releasing, "s", "time from replacement to release");
        v("peak_grip", f.peak_grip, "N",
          "peak of the grip (mean over digits), from touch to lowering");
        v("peak_grip_time", f.peak_grip_time, "s", "time of the peak of the grip, from lift-off");
        v("peak_load", f.peak_load, "N",
          "peak of the load (sum over digits), from touch to lowering");
        v("peak_grip_rate", f.peak_grip_rate, "N/s",
          "largest rate of rise of the grip before lift-off");
        v("peak_load_rate", f.peak_load_rate, "N/s",
          "largest rate of rise of the load before lift-off");
        v("lift_off_grip", f.lift_off_grip, "N", "grip at lift-off");
        v("static_grip", f.static_grip, "N",
          "mean grip in the hold: from 600 to 200 ms before lowering");
        v("static_load", f.static_load, "N", "mean load in the hold");
        v("static_ratio", f.static_ratio, "1", "ratio of static grip to static load");
        v("safety_margin", f.safety_margin, "1",
          "share of the static grip in excess of the minimum against slip");
        v("grip_load_r", f.grip_load_r, "1",
          "correlation r of the rates of grip and load while loading");
        v("grip_load_r_peak", f.grip_load_r_peak, "1",
          "largest r with the grip shifted by up to 100 ms");
        v("grip_load_lag", f.grip_load_lag, "s",
          "shift with the largest r; positive: grip follows load");
        v("slope", f.slope, "1", "slope of the line grip = offset + slope * load, while loading");
        v("offset", f.offset, "N", "offset of that line");
        v("height", f.height, "mm",
          "mean height in the hold, above the object's height at the start");
        v("overshoot", f.overshoot, "mm", "largest height above the mean height in the hold");
        v("slip", f.slip, "mm", "slip of the digit that slipped most, from lift-off to lowering");
        v("slips", f.slips, "1",
          "number of times that a touching digit slid faster than 5 mm/s, from lift-off to "
          "lowering");
        v("first_slip", f.first_slip, "s",
          "time of the first of these slips, from the session's start");
    }

    bool complete() const { return mark == "complete"; }
};

using LiftFile = RowFile<LiftRow>;
/// Reads lifts.csv, in which grip_load_r and grip_load_lag had names with "coupling" before version
/// 0.2. Throws Error when the file cannot be read.
inline LiftFile read_lifts(const std::string& file) {
    CsvFile table(file);
    table.rename("coupling", "grip_load_r");
    table.rename("coupling_lag_s", "grip_load_lag_s");
    return LiftFile(std::move(table));
}

}  // namespace dihaptic::rows
