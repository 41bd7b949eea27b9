#include "hand/repair.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/field.h"
#include "base/unmeasured.h"
#include "model/butterworth.h"

namespace dihaptic::hand {
namespace {

constexpr double kGap =
    1.75;  // in frame times; if the time between two frames is longer, frames are missing
constexpr size_t kFrozenRun = 5;  // this many equal positions, then a step, mean a frozen marker
constexpr double kFrozenStep = 0.003;  // [m]
constexpr size_t kWildRun = 5;         // maximum length of a run of wild positions [frames]

/// Checks the positions of one finger frame by frame.
class FingerRepair {
  public:
    FingerRepair(const Movement& movement, int finger, double frame)
        : movement_(movement),
          finger_(finger),
          frame_(frame),
          valid_(movement.frames.size(), true) {}

    void run(std::vector<Fault>& faults) {
        drop_missing(faults);
        // first drop wild positions, since a step to one does not mean that the marker was frozen
        drop_wild(faults);
        drop_frozen(faults);
        widen_jumps(faults);
    }
    const std::vector<char>& valid() const { return valid_; }

  private:
    const Vec3& at(size_t i) const {
        return movement_.frames[i].p_WH[static_cast<size_t>(finger_)];
    }
    double time(size_t i) const { return movement_.frames[i].time; }
    bool plausible(size_t a, size_t b) const {
        return (at(b) - at(a)).norm() <= kMaxSpeed * (time(b) - time(a) + frame_);
    }
    size_t next_valid(size_t i) const {
        do ++i;
        while (i < valid_.size() && !valid_[i]);
        return i;
    }
    /// The last valid frame before i, or i itself if there is no such frame.
    size_t last_valid(size_t i) const {
        for (size_t j = i; j > 0; --j) {
            if (valid_[j - 1]) return j - 1;
        }
        return i;
    }
    void report(std::vector<Fault>& faults, FaultKind kind, size_t first, size_t end,
                bool wrong_unit = false) const {
        Fault fault;
        fault.kind = kind;
        fault.finger = finger_;
        fault.line = movement_.frames[first].line;
        const size_t before = last_valid(first);
        const size_t after = std::min(end, valid_.size() - 1);
        const bool both_sides = before != first && end < valid_.size();
        fault.start = time(before);
        fault.end = time(after);
        fault.distance = both_sides ? (at(after) - at(before)).norm() : kUnmeasured;
        fault.wrong_unit = wrong_unit;
        if (kind == FaultKind::wild_position) {
            Vec3::Index axis = 0;
            const Vec3 off = at(first) - at(before != first ? before : after);
            fault.value = off.cwiseAbs().maxCoeff(&axis);
            fault.column =
                movement_.columns[static_cast<size_t>(finger_)][static_cast<size_t>(axis)];
        }
        faults.push_back(fault);
    }

    void drop_missing(std::vector<Fault>& faults) {
        for (size_t i = 0; i < valid_.size(); ++i) valid_[i] = at(i).allFinite();
        drop_zeros();
        for (size_t i = 0; i < valid_.size(); ++i) {
            if (valid_[i] || (i > 0 && !valid_[i - 1])) continue;
            size_t end = next_valid(i);
            report(faults, FaultKind::missing_marker, i, end);
        }
    }

    /// Drops zeros that stand for a lost marker. Many programs write 0, 0, 0 in this case, but a
    /// finger may actually be there, e.g. if positions are relative to the first one. The marker
    /// counts as lost if the adjacent frames could not be reached from 0, 0, 0.
    void drop_zeros() {
        const auto is_zero = [&](size_t i) { return valid_[i] && at(i).isZero(0); };
        for (size_t i = next_valid_from(0); i < valid_.size(); i = next_valid(i)) {
            if (!is_zero(i)) continue;
            const size_t first = i;
            size_t end = next_valid(i);
            while (end < valid_.size() && is_zero(end)) i = std::exchange(end, next_valid(end));
            const size_t before = last_valid(first);
            if ((before == first || plausible(before, first)) &&
                (end == valid_.size() || plausible(i, end)))
                continue;
            std::fill(valid_.begin() + static_cast<std::ptrdiff_t>(first),
                      valid_.begin() + static_cast<std::ptrdiff_t>(end), char{0});
        }
    }

    /// Drops repetitions of the last position of a lost marker. The tracker may or may not report
    /// the loss.
    void drop_frozen(std::vector<Fault>& faults) {
        for (size_t i = 0; i + 1 < valid_.size();) {
            size_t end = i + 1;
            bool told = false;
            for (; end < valid_.size() && valid_[i] && valid_[end] && at(end) == at(i); ++end) {
                if (movement_.frames[end].occluded) told = true;
            }
            const size_t run = end - i;
            const bool steps_after =
                end < valid_.size() && valid_[end] && (at(end) - at(i)).norm() > kFrozenStep;
            if (run > 1 && (told || (run >= kFrozenRun && steps_after))) {
                for (size_t j = i + 1; j < end; ++j) valid_[j] = false;
                report(faults, FaultKind::frozen_marker, i + 1, end);
            }
            i = std::max(end, i + 1);
        }
    }

    /// Drops positions that no hand could have reached and from which the following frames return.
    /// At the start and end of the recording, only one side can be compared: a few frames there
    /// count as wild if all other frames continue elsewhere.
    void drop_wild(std::vector<Fault>& faults) {
        const size_t n = valid_.size();
        for (size_t i = next_valid(next_valid_from(0)); i < n; i = next_valid(i)) {
            const size_t before = last_valid(i);
            if (before == i || plausible(before, i)) continue;
            if (const size_t back = taken_back(before, i); back < n) {
                drop(faults, i, back, before);
                continue;
            }
            const size_t first = next_valid_from(0);
            if (const size_t count = usable(first, i); count <= kWildRun && together(i) > count) {
                drop(faults, first, i, i);
            } else if (usable(i, n) <= kWildRun) {
                drop(faults, i, n, before);
            }
        }
    }
    /// Returns the first frame after i that a hand at frame `before` could reach, or the end if
    /// there is none.
    size_t taken_back(size_t before, size_t i) const {
        size_t last = i;
        size_t back = next_valid(i);
        for (size_t n = 0; n < kWildRun && back < valid_.size(); ++n) {
            // must also jump back: a movement that continues from the new position is a jump
            if (!plausible(last, back) && plausible(before, back)) return back;
            last = back;
            back = next_valid(back);
        }
        return valid_.size();
    }
    size_t next_valid_from(size_t i) const {
        return i < valid_.size() && valid_[i] ? i : next_valid(i);
    }
    size_t usable(size_t first, size_t end) const {
        return static_cast<size_t>(std::count(valid_.begin() + static_cast<std::ptrdiff_t>(first),
                                              valid_.begin() + static_cast<std::ptrdiff_t>(end),
                                              char{1}));
    }
    /// Number of frames from i on with no implausible step between them, counted only as far as
    /// necessary.
    size_t together(size_t i) const {
        size_t count = 1;
        for (size_t next = next_valid(i);
             count <= kWildRun && next < valid_.size() && plausible(i, next);
             next = next_valid(i)) {
            i = next;
            ++count;
        }
        return count;
    }
    /// Drops the wild frames [first, end); `beside` is a good frame next to the range.
    void drop(std::vector<Fault>& faults, size_t first, size_t end, size_t beside) {
        const bool thousandth = at(first).norm() < 2e-3 * at(beside).norm() &&
                                at(first).norm() > 0.5e-3 * at(beside).norm();
        for (size_t j = first; j < end; ++j) valid_[j] = false;
        report(faults, FaultKind::wild_position, first, end, thousandth);
    }

    /// Gives a jump between two positions more time, by dropping frames on both sides of it.
    void widen_jumps(std::vector<Fault>& faults) {
        for (size_t i = next_valid(0); i < valid_.size(); i = next_valid(i)) {
            size_t before = last_valid(i);
            if (before == i || plausible(before, i)) continue;
            const size_t first = i;
            size_t after = i;
            while ((at(after) - at(before)).norm() > kBridgeSpeed * (time(after) - time(before))) {
                const size_t wider_after = next_valid(after);
                const size_t wider_before = last_valid(before);
                if (wider_after >= valid_.size() && wider_before == before) break;
                if (wider_after < valid_.size()) {
                    valid_[after] = false;
                    after = wider_after;
                }
                if (wider_before != before) {
                    valid_[before] = false;
                    before = wider_before;
                }
            }
            report(faults, FaultKind::jump, first, after);
            i = after;
        }
    }

    const Movement& movement_;
    int finger_;
    double frame_;
    std::vector<char> valid_;
};

/// Monotone cubic interpolation (Fritsch and Carlson 1980), which never overshoots its samples.
class MonotoneCubic {
  public:
    MonotoneCubic(std::vector<double> x, std::vector<double> y)
        : x_(std::move(x)), y_(std::move(y)), slope_(x_.size(), 0) {
        const size_t n = x_.size();
        std::vector<double> h(n - 1), d(n - 1);
        for (size_t i = 0; i + 1 < n; ++i) {
            h[i] = x_[i + 1] - x_[i];
            d[i] = (y_[i + 1] - y_[i]) / h[i];
        }
        for (size_t i = 1; i + 1 < n; ++i) {
            if (d[i - 1] * d[i] <= 0) continue;
            const double w1 = 2 * h[i] + h[i - 1];
            const double w2 = h[i] + 2 * h[i - 1];
            slope_[i] = (w1 + w2) / (w1 / d[i - 1] + w2 / d[i]);
        }
    }
    double operator()(double x) const {
        if (x <= x_.front()) return y_.front();
        if (x >= x_.back()) return y_.back();
        const auto i =
            static_cast<size_t>(std::upper_bound(x_.begin(), x_.end(), x) - x_.begin()) - 1;
        const double h = x_[i + 1] - x_[i];
        const double s = (x - x_[i]) / h;
        const double s2 = s * s;
        const double s3 = s2 * s;
        return (2 * s3 - 3 * s2 + 1) * y_[i] + (s3 - 2 * s2 + s) * h * slope_[i] +
               (3 * s2 - 2 * s3) * y_[i + 1] + (s3 - s2) * h * slope_[i + 1];
    }

  private:
    std::vector<double> x_, y_, slope_;
};

void find_gaps(const Movement& movement, double frame, std::vector<Fault>& faults) {
    for (size_t i = 1; i < movement.frames.size(); ++i) {
        const Movement::Frame& a = movement.frames[i - 1];
        const Movement::Frame& b = movement.frames[i];
        if (b.time - a.time <= kGap * frame) continue;
        Fault fault;
        fault.start = a.time;
        fault.end = b.time;
        fault.line = b.line;
        for (size_t f = 0; f < a.p_WH.size(); ++f) {
            if (a.p_WH[f].allFinite() && b.p_WH[f].allFinite()) {
                fault.distance = std::max(fault.distance, (b.p_WH[f] - a.p_WH[f]).norm());
            }
        }
        faults.push_back(fault);
    }
}

}  // namespace

double Path::bridged_share() const {
    if (bridged.empty()) return 0;
    return static_cast<double>(std::count(bridged.begin(), bridged.end(), char{1})) /
           static_cast<double>(bridged.size());
}

Path repair(const Movement& movement) {
    Path path;
    path.fingers = movement.fingers;
    const double frame = movement.frame_time();
    const double t0 = movement.frames.front().time;
    const double t1 = movement.frames.back().time;
    const auto samples = static_cast<size_t>(std::floor((t1 - t0) * Path::kRate)) + 1;
    path.bridged.assign(samples, 0);
    find_gaps(movement, frame, path.faults);

    for (size_t f = 0; f < movement.fingers.size(); ++f) {
        FingerRepair finger(movement, static_cast<int>(f), frame);
        finger.run(path.faults);
        std::vector<double> times;
        std::array<std::vector<double>, 3> values;
        for (size_t i = 0; i < movement.frames.size(); ++i) {
            if (!finger.valid()[i]) continue;
            times.push_back(movement.frames[i].time - t0);
            for (size_t axis = 0; axis < 3; ++axis)
                values[axis].push_back(movement.frames[i].p_WH[f][static_cast<int>(axis)]);
        }
        if (times.size() < 4) {
            throw Error({movement.file, 0}, movement.fingers[f],
                        "fewer than four frames are usable", "Record this movement again.");
        }
        // bridge the samples at the ends, and those between frames that are too far apart
        const auto mark = [&](double from, double to) {
            const auto first = static_cast<size_t>(std::max(0.0, std::ceil(from * Path::kRate)));
            for (size_t s = first; s < samples && static_cast<double>(s) / Path::kRate < to; ++s)
                path.bridged[s] = 1;
        };
        if (times.front() > 0) mark(0, times.front());
        for (size_t i = 1; i < times.size(); ++i) {
            if (times[i] - times[i - 1] > kGap * frame) mark(times[i - 1], times[i]);
        }
        if (times.back() < t1 - t0) mark(times.back(), t1 - t0 + 1);

        std::vector<Vec3>& out = path.p_WH.emplace_back(samples);
        for (size_t axis = 0; axis < 3; ++axis) {
            const MonotoneCubic curve(times, values[axis]);
            std::vector<double> sampled(samples);
            for (size_t s = 0; s < samples; ++s)
                sampled[s] = curve(static_cast<double>(s) / Path::kRate);
            sampled = model::low_pass(sampled, kSmoothing, Path::kRate);
            for (size_t s = 0; s < samples; ++s) out[s][static_cast<int>(axis)] = sampled[s];
        }
    }
    std::stable_sort(path.faults.begin(), path.faults.end(),
                     [](const Fault& a, const Fault& b) { return a.start < b.start; });
    return path;
}

std::string describe(const Fault& fault, const std::vector<std::string>& fingers) {
    const std::string who =
        fault.finger < 0 ? "" : fingers[static_cast<size_t>(fault.finger)] + ": ";
    std::string text = fmt::format("{:.3f} to {:.3f} s: {}{}, {:.0f} ms", fault.start, fault.end,
                                   who, enum_name(fault.kind), (fault.end - fault.start) * 1e3);
    if (!fault.column.empty() && std::isfinite(fault.value)) {
        text += fmt::format(", {} deviates by {:.5g} mm", fault.column, fault.value * 1e3);
    }
    if (std::isfinite(fault.distance))
        text += fmt::format(", {:.1f} mm apart", fault.distance * 1e3);
    if (fault.wrong_unit)
        text +=
            "; its values are a thousandth of their neighbours': if they are in metres, multiply "
            "them by 1000";
    return text;
}

}  // namespace dihaptic::hand
