#include "analysis/lifts.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

#include "analysis/savitzky_golay.h"
#include "model/grasp.h"

namespace dihaptic::analysis {
namespace {

constexpr double kRateWindow = 0.062;  // window for the rates [s]
constexpr double kQuiet = 0.1;         // quiet time at the start, before any event [s]
constexpr double kLeastHeight = 0.01;  // minimum height of a lift [m]
constexpr double kRising = 0.01;       // [m/s]
constexpr double kSinking = -0.02;     // [m/s]
constexpr double kLoaded = 0.2;        // [N]
constexpr double kLagMost = 0.1;       // [s]
constexpr double kSlipSpeed = 5e-3;    // [m/s]
constexpr double kLeastRate =
    0.2;  // minimum threshold, because a noise-free window has an SD of 0 [N/s]
constexpr double kBounce =
    0.05;  // a bounce separates a digit from the object for less than this time [s]
constexpr double kParting = 0.2;  // minimum time untouched on the support between two lifts [s]
constexpr double kLoadShare =
    0.02;  // fraction of the load at lift-off below which a load counts as zero

using Signal = std::vector<double>;

double mean(std::span<const double> x) {
    return std::accumulate(x.begin(), x.end(), 0.0) / static_cast<double>(x.size());
}

double spread(std::span<const double> x) {
    const double centre = mean(x);
    double sum = 0;
    for (const double value : x) sum += (value - centre) * (value - centre);
    return std::sqrt(sum / static_cast<double>(x.size()));
}

std::span<const double> part(const Signal& x, Range range) {
    return std::span(x).subspan(range.first, range.size());
}

/// Pearson's r between x and y, with y shifted by `lag` samples, over a range of x.
double correlation(const Signal& x, const Signal& y, Range range, int lag) {
    double xy = 0;
    double xx = 0;
    double yy = 0;
    const auto shifted = [&](size_t i) {
        const auto at = std::clamp<int64_t>(static_cast<int64_t>(i) + lag, 0,
                                            static_cast<int64_t>(y.size()) - 1);
        return y[static_cast<size_t>(at)];
    };
    double mean_y = 0;
    for (size_t i = range.first; i < range.last; ++i)
        mean_y += shifted(i) / static_cast<double>(range.size());
    const double mean_x = mean(part(x, range));
    for (size_t i = range.first; i < range.last; ++i) {
        const double dx = x[i] - mean_x;
        const double dy = shifted(i) - mean_y;
        xy += dx * dy;
        xx += dx * dx;
        yy += dy * dy;
    }
    return xx > 0 && yy > 0 ? xy / std::sqrt(xx * yy) : kUnmeasured;
}

/// The signals of an attempt, one value per sample.
struct Signals {
    explicit Signals(const GraspTrace& trace, const Vec3& gravity) : tick(trace.tick()) {
        const Vec3 down = gravity.norm() > 0 ? Vec3(gravity.normalized()) : Vec3(-Vec3::UnitZ());
        const size_t n = trace.fingers();
        digit_grip.resize(n);
        digit_load.resize(n);
        for (const GraspTrace::Sample& s : trace.samples()) {
            double sum_grip = 0;
            double sum_load = 0;
            for (size_t f = 0; f < n; ++f) {
                digit_grip[f].push_back(s.normal_force[f]);
                digit_load[f].push_back(s.f_tangential_W[f].dot(down));
                sum_grip += digit_grip[f].back();
                sum_load += digit_load[f].back();
            }
            grip.push_back(sum_grip / static_cast<double>(n));
            load.push_back(sum_load);
            height.push_back(-down.dot(s.X_WB.p));
            rise.push_back(-down.dot(s.v_WB));
        }
        // the object's position is unknown after missing ticks
        const auto known =
            std::find_if(height.begin(), height.end(), [](double h) { return std::isfinite(h); });
        const double rest = known == height.end() ? kUnmeasured : *known;
        for (double& h : height) h -= rest;
    }
    /// Largest height; NaN if the height is never known.
    double top() const {
        double out = kUnmeasured;
        for (const double h : height) out = std::fmax(out, h);
        return out;
    }
    size_t size() const { return grip.size(); }
    size_t samples(double time) const { return static_cast<size_t>(std::round(time / tick)); }

    double tick;
    Signal grip, load;    // [N]
    Signal height, rise;  // height above the initial position [m], and its rate of change [m/s]
    std::vector<Signal> digit_grip, digit_load;  // indexed by finger [N]
};

/// Threshold for the rate of a force, from the mean and SD of the rate in the quiet time.
double threshold(const Signals& signals, const Signal& rate) {
    const auto quiet = std::span(rate).first(std::min(rate.size(), signals.samples(kQuiet)));
    return std::max(kLeastRate, mean(quiet) + 4 * spread(quiet));
}

/// Returns the sample in which a digit touches the object; nullopt if it never does. `force`
/// contains all samples of the digit, or only the first ones.
std::optional<size_t> touch(const Signals& signals, std::span<const double> force,
                            const Signal& rate) {
    const auto largest = std::max_element(force.begin(), force.end());
    if (*largest <= 0) return std::nullopt;
    const double limit = threshold(signals, rate);
    auto i = static_cast<size_t>(
        std::find_if(force.begin(), force.end(), [&](double f) { return f >= *largest / 4; }) -
        force.begin());
    while (i > 0 && rate[i] > limit) --i;
    return i;
}

/// Returns the sample after `replaced` in which a digit releases the object; nullopt if it does
/// not.
std::optional<size_t> release(const Signals& signals, const Signal& force, const Signal& rate,
                              size_t replaced) {
    const double limit = threshold(signals, rate);
    size_t i = replaced;
    while (i < force.size() && force[i] > force[replaced] / 4) ++i;
    while (i < force.size() && rate[i] < -limit) ++i;
    if (i == force.size()) return std::nullopt;
    return i;
}

std::optional<size_t> load_onset(const Signals& signals, const Signal& load, size_t touched) {
    size_t i = touched;
    while (i < load.size() && load[i] <= kLoaded) ++i;
    if (i == load.size()) return std::nullopt;
    const Signal bend = savitzky_golay(load, signals.tick, kRateWindow, 2);
    while (i > touched && bend[i] > 0) --i;
    return i;
}

/// Finds the number of slips of the digits on the object, the time of the first one, and the size
/// of the largest.
void find_slips(rows::LiftRow& lift, const GraspTrace& trace, Range range) {
    lift.slip = 0;
    for (size_t f = 0; f < trace.fingers(); ++f) {
        lift.slip = std::max(lift.slip, trace.slip(range, f));
        Signal speed(range.size(), 0);
        for (size_t i = range.first + 1; i < range.last; ++i) {
            const auto place = [&](size_t at) {
                const GraspTrace::Sample& s = trace.samples()[at];
                return Vec3(s.X_WB.inverse() * s.p_WP[f]);
            };
            speed[i - range.first] = (place(i) - place(i - 1)).norm() / trace.tick();
        }
        bool slid = false;
        for (size_t i = 0; i < speed.size(); ++i) {
            const GraspTrace::Sample& sample = trace.samples()[range.first + i];
            const bool slides = speed[i] > kSlipSpeed && sample.touching[f];
            if (slides && !slid) {
                ++lift.slips;
                lift.first_slip = std::fmin(lift.first_slip, sample.time);
            }
            slid = slides;
        }
    }
}

/// Computes the coupling between grip and load while the digits were loading the object.
void find_coupling(rows::LiftRow& lift, const Signals& signals, const Signal& grip_rate,
                   const Signal& load_rate, Range loading) {
    if (loading.size() < signals.samples(0.02)) return;
    lift.grip_load_r = correlation(load_rate, grip_rate, loading, 0);
    const auto most = static_cast<int>(signals.samples(kLagMost));
    for (int lag = -most; lag <= most; ++lag) {
        const double r = correlation(load_rate, grip_rate, loading, lag);
        if (!(r <= lift.grip_load_r_peak)) {
            lift.grip_load_r_peak = r;
            lift.grip_load_lag = lag * signals.tick;
        }
    }
    const auto grip = part(signals.grip, loading);
    const auto load = part(signals.load, loading);
    const double mean_grip = mean(grip);
    const double mean_load = mean(load);
    double xy = 0;
    double xx = 0;
    for (size_t i = 0; i < grip.size(); ++i) {
        xy += (load[i] - mean_load) * (grip[i] - mean_grip);
        xx += (load[i] - mean_load) * (load[i] - mean_load);
    }
    if (xx <= 0) return;
    lift.slope = xy / xx;
    lift.offset = mean_grip - lift.slope * mean_load;
}

/// Ratio of load to mean grip per digit at which all digits slip, i.e. the mean of the digits'
/// friction coefficients.
double friction_of(const GraspTrace::Sample& sample, std::span<const double> friction) {
    double sum = 0;
    int count = 0;
    for (size_t f = 0; f < friction.size() && f < sample.touching.size(); ++f) {
        if (!sample.touching[f]) continue;
        sum += sample.friction_scale * friction[f];
        ++count;
    }
    return count > 0 ? sum / count : kUnmeasured;
}

/// Whether the object presses on a body other than a finger. A sleeping object also stands,
/// although it has no contacts.
bool stands(const GraspTrace::Sample& s) {
    return s.on_support || !s.awake;
}

/// Sample numbers of the events. A digit event has a number for each digit that shows it.
struct Events {
    size_t lift_off = 0;
    std::vector<size_t> touches;
    std::vector<size_t> onsets;
    std::optional<size_t> replacement;
    std::vector<std::optional<size_t>> releases;
};

/// Returns the range from the first to the last sample in which the object is at or above half of
/// its top height.
Range high_of(const Signals& signals, double top) {
    const auto high = [&](double h) { return h >= top / 2; };
    const auto first = std::find_if(signals.height.begin(), signals.height.end(), high);
    const auto last = std::find_if(signals.height.rbegin(), signals.height.rend(), high);
    return {static_cast<size_t>(first - signals.height.begin()),
            signals.size() - static_cast<size_t>(last - signals.height.rbegin())};
}

/// Finds events by the rules for data that have no contacts.
class ByForce {
  public:
    ByForce(const GraspTrace& trace, const Signals& signals, Range high)
        : trace_(trace), signals_(signals), high_(high) {
        for (const Signal& force : signals.digit_grip)
            rates_.push_back(savitzky_golay(force, signals.tick, kRateWindow, 1));
    }

    Events find() const {
        Events out;
        out.lift_off = lift_off();
        for (size_t f = 0; f < trace_.fingers(); ++f) {
            const Signal& force = signals_.digit_grip[f];
            auto at = touch(signals_, force, rates_[f]);
            if (at > out.lift_off)
                at = touch(signals_, std::span(force).first(out.lift_off + 1), rates_[f]);
            if (!at) continue;
            out.touches.push_back(*at);
            const auto onset = load_onset(signals_, signals_.digit_load[f], *at);
            if (onset && *onset <= out.lift_off) out.onsets.push_back(*onset);
        }
        size_t replaced = high_.last - 1;
        while (replaced < signals_.size() && signals_.rise[replaced] < kSinking) ++replaced;
        if (replaced == signals_.size() || replaced < high_.last) return out;
        out.replacement = replaced;
        for (size_t f = 0; f < trace_.fingers(); ++f)
            out.releases.push_back(release(signals_, signals_.digit_grip[f], rates_[f], replaced));
        return out;
    }

  private:
    /// Returns the sample before the object starts to rise fast or, if the object was lifted slowly
    /// and left its support earlier, the sample in which it left the support.
    size_t lift_off() const {
        size_t lifted = high_.first;
        while (lifted > 0 && signals_.rise[lifted] > kRising) --lifted;
        size_t free = lifted;
        while (free > 0 && !stands(trace_.samples()[free - 1])) --free;
        return free > 0 ? free : lifted;
    }

    const GraspTrace& trace_;
    const Signals& signals_;
    Range high_;
    std::vector<Signal> rates_;
};

/// Finds events from contacts; each event is at the sample in which it occurs.
class ByContact {
  public:
    ByContact(const GraspTrace& trace, const Signals& signals, Range high)
        : trace_(trace), signals_(signals), high_(high) {}

    /// Returns nullopt if the trace does not show the object leaving its support.
    std::optional<Events> find() const {
        Events out;
        out.lift_off = high_.first;
        while (out.lift_off > 0 && !stands(sample(out.lift_off - 1))) --out.lift_off;
        if (out.lift_off == 0) return std::nullopt;
        for (size_t f = 0; f < trace_.fingers(); ++f) {
            const auto at = touch(f, out.lift_off);
            if (!at) continue;
            out.touches.push_back(*at);
            if (const auto onset = load_onset(f, *at, out.lift_off)) out.onsets.push_back(*onset);
        }
        size_t replaced = high_.last;
        while (replaced < signals_.size() && !stands(sample(replaced))) ++replaced;
        if (replaced == signals_.size()) return out;
        out.replacement = replaced;
        for (size_t f = 0; f < trace_.fingers(); ++f) out.releases.push_back(release(f, replaced));
        return out;
    }

  private:
    const GraspTrace::Sample& sample(size_t i) const { return trace_.samples()[i]; }

    /// Returns the sample in which the digit began to press continuously until lift-off.
    std::optional<size_t> touch(size_t f, size_t lift_off) const {
        std::optional<size_t> began;
        const size_t bounce = signals_.samples(kBounce);
        for (size_t i = lift_off + 1; i-- > 0;) {
            if (sample(i).touching[f]) {
                began = i;
            } else if (began.value_or(lift_off) > i + bounce) {
                break;
            }
        }
        return began;
    }

    std::optional<size_t> load_onset(size_t f, size_t touched, size_t lift_off) const {
        const Signal& load = signals_.digit_load[f];
        const double none = kLoadShare * load[lift_off];
        if (none <= 0) return std::nullopt;
        size_t i = lift_off;
        while (i > touched && load[i - 1] > none) --i;
        return i;
    }

    std::optional<size_t> release(size_t f, size_t replaced) const {
        size_t last = replaced;  // last sample in which the digit pressed on the object
        const size_t bounce = signals_.samples(kBounce);
        for (size_t i = replaced; i < signals_.size(); ++i) {
            if (sample(i).touching[f]) {
                last = i;
            } else if (i > last + bounce) {
                return last + 1;
            }
        }
        return last + 1 < signals_.size() ? std::optional(last + 1) : std::nullopt;
    }

    const GraspTrace& trace_;
    const Signals& signals_;
    Range high_;
};

/// Finds the events, and stores in `lift` the rule by which they were found.
Events find_events(rows::LiftRow& lift, const GraspTrace& trace, const Signals& signals, Range high,
                   std::optional<rows::EventRule> rule) {
    const auto& samples = trace.samples();
    const bool seen = std::any_of(samples.begin(), samples.end(), stands);
    if (rule.value_or(seen ? rows::EventRule::contact : rows::EventRule::force) ==
        rows::EventRule::contact) {
        if (auto events = ByContact(trace, signals, high).find()) {
            lift.rule = rows::EventRule::contact;
            return *std::move(events);
        }
    }
    lift.rule = rows::EventRule::force;
    return ByForce(trace, signals, high).find();
}

bool was_paused(const GraspTrace& trace) {
    return std::any_of(trace.samples().begin(), trace.samples().end(),
                       [](const GraspTrace::Sample& s) { return s.resumed; });
}

/// Returns the sample in which the object starts to be lowered, but not before lift-off.
size_t lowering_of(const Signals& signals, Range high, size_t lift_off) {
    size_t lowered = high.last - 1;
    while (lowered > lift_off && signals.rise[lowered] < kSinking) --lowered;
    return lowered;
}

/// Computes the times and durations from touch to lift-off.
void find_start(rows::LiftRow& lift, const GraspTrace& trace, const Signals& signals,
                const Events& events) {
    const auto time = [&](size_t i) { return trace.samples()[i].time; };
    lift.lift_off = time(events.lift_off);
    lift.lift_off_grip = signals.grip[events.lift_off];
    if (events.onsets.empty()) return;
    const auto [first, last] = std::minmax_element(events.onsets.begin(), events.onsets.end());
    lift.load_onset = time(*first);
    lift.preload = lift.load_onset - lift.touch;
    lift.loading = lift.lift_off - time(*last);
}

/// Finds the peaks of the forces from touch to lowering.
void find_peaks(rows::LiftRow& lift, const GraspTrace& trace, const Signals& signals, Range up) {
    const auto grip = part(signals.grip, up);
    const auto peak = std::max_element(grip.begin(), grip.end());
    lift.peak_grip = *peak;
    lift.peak_grip_time =
        trace.samples()[up.first + static_cast<size_t>(peak - grip.begin())].time - lift.lift_off;
    const auto load = part(signals.load, up);
    lift.peak_load = *std::max_element(load.begin(), load.end());
}

/// Finds the largest rates of change of the forces before lift-off, and the coupling of the forces.
void find_rates(rows::LiftRow& lift, const Signals& signals, const Events& events, size_t touched) {
    const Signal grip_rate = savitzky_golay(signals.grip, signals.tick, kRateWindow, 1);
    const Signal load_rate = savitzky_golay(signals.load, signals.tick, kRateWindow, 1);
    const size_t end = events.lift_off + 1;
    const auto largest = [&](const Signal& rate) {
        const auto range = part(rate, {touched, end});
        return *std::max_element(range.begin(), range.end());
    };
    lift.peak_grip_rate = largest(grip_rate);
    lift.peak_load_rate = largest(load_rate);
    if (events.onsets.empty()) return;
    const size_t loaded = *std::min_element(events.onsets.begin(), events.onsets.end());
    find_coupling(lift, signals, grip_rate, load_rate, {loaded, end});
}

/// Returns the range before lowering in which forces and height have settled; nullopt if the lift
/// is too short.
std::optional<Range> hold_of(const Signals& signals, size_t lift_off, size_t lowered) {
    const size_t early = signals.samples(0.6);
    const size_t late = signals.samples(0.2);
    if (lowered < lift_off + early) return std::nullopt;
    return Range{lowered - early, lowered - late};
}

void average_hold(rows::LiftRow& lift, const GraspTrace& trace, const Signals& signals, Range hold,
                  std::span<const double> friction) {
    lift.static_grip = mean(part(signals.grip, hold));
    lift.static_load = mean(part(signals.load, hold));
    if (lift.static_load > kLoaded) lift.static_ratio = lift.static_grip / lift.static_load;
    const double mu = friction_of(trace.samples()[hold.first], friction);
    if (lift.static_load > kLoaded && mu > 0)
        lift.safety_margin = model::safety_margin(lift.static_grip, lift.static_load, mu);
    lift.height = mean(part(signals.height, hold));
}

bool is_touched(const GraspTrace& trace, Range range) {
    for (size_t i = range.first; i < range.last; ++i) {
        if (trace.samples()[i].touched()) return true;
    }
    return false;
}

/// Returns how far the object moved along the digit for which this movement is smallest, out of the
/// digits that touched the object throughout. Returns 0 if no digit did, as when the object is
/// handed over.
double slid_down(const GraspTrace& trace, Range air) {
    std::optional<double> out;
    for (size_t f = 0; f < trace.fingers(); ++f) {
        bool throughout = true;
        for (size_t i = air.first; i < air.last && throughout; ++i)
            throughout = trace.samples()[i].touching[f] != 0;
        if (throughout) out = std::min(out.value_or(trace.slip(air, f)), trace.slip(air, f));
    }
    return out.value_or(0);
}

/// Finds replacement and release. Sets the lift's mark to what went wrong, or to "complete". `top`:
/// largest height of the object.
void find_end(rows::LiftRow& lift, const GraspTrace& trace, const Events& events, double top) {
    lift.mark = "not put down";
    if (!events.replacement) return;
    lift.replacement = trace.samples()[*events.replacement].time;
    lift.mark = "dropped";
    const Range air{events.lift_off, *events.replacement};
    for (size_t i = air.first; i < air.last; ++i) {
        if (!trace.samples()[i].touched()) return;
    }
    if (slid_down(trace, air) > top / 2) return;
    lift.mark = "not released";
    size_t released = *events.replacement;
    for (const std::optional<size_t>& at : events.releases) {
        if (!at) return;
        released = std::max(released, *at);
    }
    lift.release = trace.samples()[released].time;
    lift.releasing = lift.release - lift.replacement;
    lift.mark = "complete";
}

}  // namespace

std::vector<Range> lifts_in(const GraspTrace& trace, const Vec3& gravity) {
    const Signals signals(trace, gravity);
    const size_t parting = signals.samples(kParting);
    std::vector<Range> out(1);
    double floor = kUnmeasured;  // height of the object when it last stood
    bool lifted = false;
    size_t alone = 0;  // number of samples for which the object has stood untouched
    for (size_t i = 0; i < signals.size(); ++i) {
        const GraspTrace::Sample& sample = trace.samples()[i];
        alone = stands(sample) && !sample.touched() ? alone + 1 : 0;
        if (stands(sample) && !lifted) floor = signals.height[i];
        // a pause between two lifts belongs to neither lift
        if (sample.resumed && !lifted && alone > 0) out.back().first = i + 1;
        lifted = lifted || signals.height[i] - floor >= kLeastHeight;
        if (!lifted || alone < parting) continue;
        out.back().last = i + 1;
        out.push_back({i + 1, i + 1});
        lifted = false;
    }
    out.back().last = signals.size();
    if (out.size() > 1 && !is_touched(trace, out.back())) out.pop_back();
    return out;
}

rows::LiftRow find_lift(const GraspTrace& trace, const Vec3& gravity,
                        std::span<const double> friction, std::optional<rows::EventRule> rule) {
    rows::LiftRow lift;
    lift.mark = "no touch";
    if (trace.samples().empty() || trace.fingers() == 0) return lift;
    if (was_paused(trace)) {
        lift.mark = "paused";
        return lift;
    }
    const Signals signals(trace, gravity);
    const double top = signals.top();
    if (!std::isfinite(top)) {
        lift.mark = "place not known";
        return lift;
    }
    const Range high = high_of(signals, top);
    const Events events = find_events(lift, trace, signals, high, rule);
    if (events.touches.empty()) return lift;
    const size_t touched = *std::min_element(events.touches.begin(), events.touches.end());
    lift.touch = trace.samples()[touched].time;

    lift.mark = "not lifted";
    if (top < kLeastHeight) return lift;
    const size_t lowered = lowering_of(signals, high, events.lift_off);
    find_start(lift, trace, signals, events);
    find_peaks(lift, trace, signals, {touched, lowered + 1});
    find_rates(lift, signals, events, touched);
    find_slips(lift, trace, {events.lift_off, lowered + 1});
    const std::optional<Range> hold = hold_of(signals, events.lift_off, lowered);
    if (hold) {
        average_hold(lift, trace, signals, *hold, friction);
        lift.overshoot = top - lift.height;
    }
    find_end(lift, trace, events, top);
    if (lift.complete() && !hold) lift.mark = "no hold";
    return lift;
}

}  // namespace dihaptic::analysis
