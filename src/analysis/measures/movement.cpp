#include "analysis/measures/movement.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>
#include <numeric>

#include "analysis/trials.h"
#include "base/figure.h"
#include "base/unmeasured.h"

namespace dihaptic::analysis {
namespace {

constexpr double kLeastPeak = 0.05;        // slower movements are tremor or noise [m/s]
constexpr double kGripBefore = 0.2;        // duration of the usual grip before a load step [s]
constexpr double kLeastGripBefore = 0.05;  // [s]
constexpr double kGripLasts = 0.01;        // time for which grip must stay above the threshold [s]
constexpr double kGripSpreads = 3;         // threshold, in standard deviations
constexpr double kLeastRise = 0.05;  // minimum threshold, as noise-free grip has an SD of 0 [N]
constexpr double kToMm2 = 1e6;
constexpr double kLeastTime = 0.05;   // minimum duration of a movement [s]
constexpr double kLeastShare = 0.1;   // fraction of the line that a movement must cover
constexpr double kIndexTime = 0.1;    // minimum duration of a movement for comparing forces [s]
constexpr double kIndexShare = 0.5;   // fraction of the line that such a movement must cover
constexpr double kLeastIdeal = 0.05;  // minimum root mean square of the ideal force [N]

using Values = std::vector<double>;

/// Returns the value with the largest magnitude, with its sign.
double largest_by_size(std::span<const double> x) {
    return *std::max_element(x.begin(), x.end(),
                             [](double a, double b) { return std::abs(a) < std::abs(b); });
}

double time_of_phase(const std::vector<MotionSample>& samples, int phase) {
    const auto in = [&](const MotionSample& s) { return s.phase == phase; };
    const auto found = std::find_if(samples.begin(), samples.end(), in);
    return found == samples.end() ? kUnmeasured : found->time;
}

/// Linear least-squares regression of y on x.
struct Regression {
    Regression(std::span<const double> x, std::span<const double> y) {
        const auto n = static_cast<double>(x.size());
        const double mean_x = std::accumulate(x.begin(), x.end(), 0.0) / n;
        const double mean_y = std::accumulate(y.begin(), y.end(), 0.0) / n;
        double x2 = 0, raw_xy = 0, xx = 0, xy = 0, yy = 0;
        for (size_t i = 0; i < x.size(); ++i) {
            x2 += x[i] * x[i];
            raw_xy += x[i] * y[i];
            xx += (x[i] - mean_x) * (x[i] - mean_x);
            xy += (x[i] - mean_x) * (y[i] - mean_y);
            yy += (y[i] - mean_y) * (y[i] - mean_y);
        }
        through_zero = x2 > 0 ? raw_xy / x2 : kUnmeasured;
        slope = xx > 0 ? xy / xx : kUnmeasured;
        offset = mean_y - slope * mean_x;
        // rounding may lead beyond 1, which no correlation can be
        r2 = xx > 0 && yy > 0 ? std::min(1.0, xy * xy / (xx * yy)) : kUnmeasured;
    }
    double through_zero, slope, offset, r2;
};

size_t columns_in(const task::MeasureRow& row) {
    return static_cast<size_t>(
        std::count_if(row.columns.begin(), row.columns.end(),
                      [](const task::MeasureColumn& c) { return c.name != nullptr; }));
}

/// Removes values outside their plausible range.
void leave_out_nonsense(const task::MeasureRow& row, MeasuredValues& measured) {
    for (size_t i = 0; i < measured.values.size(); ++i) {
        const task::MeasureColumn& column = row.columns[i];
        const double value = measured.values[i] * figure_form(column.name, column.unit).scale;
        if (std::isnan(value) || (value >= column.least && value <= column.most)) continue;
        measured.values[i] = kUnmeasured;
        if (!measured.why.empty()) measured.why += ", ";
        measured.why += fmt::format("{} would be {:.4g}, outside {:g} to {:g}", column.name, value,
                                    column.least, column.most);
    }
}

}  // namespace

AttemptMeasures::AttemptMeasures(const Attempt& attempt, const task::Movement& options,
                                 const MeasurePhases& phases, double tick)
    : attempt_(attempt),
      options_(options),
      tick_(tick),
      go_(phases.go >= 0            ? time_of_phase(attempt.samples, phases.go)
          : attempt.samples.empty() ? kUnmeasured
                                    : attempt.samples.front().time),
      step_(time_of_phase(attempt.samples, phases.step)) {
    along_W_ = attempt_.plan.along_W();
    left_W_ = attempt_.plan.left_W();
    no_onset_ = find_movement(phases);
    if (!no_onset_.empty()) no_end_ = no_onset_;
    find_lines();
}

std::string AttemptMeasures::find_movement(const MeasurePhases& phases) {
    if (std::string why = find_run(phases); !why.empty()) return why;
    const std::span<const double> speed = speed_;
    // a stroke that began before the states, or that is too small, is skipped
    bool before = false;
    for (size_t from = 0;;) {
        const Stroke stroke = first_stroke(speed.subspan(from));
        const size_t next = from + stroke.end;
        find_ends(from, from + stroke.peak);
        before = onset_ == from && (from == 0 || before);
        continued_ = before && from == 0 && options_.continues;
        before = before && !continued_;
        const std::string small = why_too_small();
        if ((before || !small.empty()) && next + 1 < speed.size()) {
            from = next;
            continue;
        }
        if (!(speed[peak_] >= options_.onset_speed.value_or(kLeastPeak))) return "no movement";
        if (before) return "the movement began before its states";
        if (end_ == run_.size()) no_end_ = "the movement was not over when its states ended";
        return small;
    }
}

/// Finds the onset (at or after a given tick) and the end of the movement around the peak of a
/// stroke.
void AttemptMeasures::find_ends(size_t from, size_t peak) {
    peak_ = onset_ = peak;
    const double threshold = options_.onset_speed.value_or(options_.onset_share * speed_[peak]);
    while (onset_ > from && speed_[onset_ - 1] >= threshold) --onset_;
    // shorter pauses count as part of the movement
    const auto pause = static_cast<size_t>(std::round(options_.end_still / tick_));
    end_ = run_.size();
    size_t slow = 0;
    for (size_t i = peak; i < run_.size() && end_ == run_.size(); ++i) {
        slow = speed_[i] < threshold ? slow + 1 : 0;
        if (slow > pause) end_ = i - pause;
    }
}

std::string AttemptMeasures::find_run(const MeasurePhases& phases) {
    const auto moves = [&](const MotionSample& s) {
        return std::find(phases.during.begin(), phases.during.end(), s.phase) !=
               phases.during.end();
    };
    const auto first = std::find_if(attempt_.samples.begin(), attempt_.samples.end(), moves);
    run_ = {first, std::find_if_not(first, attempt_.samples.end(), moves)};
    if (run_.empty()) return "its states were not reached";
    for (const MotionSample& s : run_) {
        if (!s.continues && &s != &run_.front())
            return "ticks are missing, or the session was paused";
        speed_.push_back(in_channel() ? std::abs(s.v_W.dot(along_W_)) : s.v_W.norm());
    }
    return "";
}

double AttemptMeasures::extent(bool along) const {
    double out = 0;
    for (size_t i = onset_; i < std::min(end_ + 1, run_.size()); ++i) {
        const Vec3 moved = run_[i].p_W - run_[onset_].p_W;
        out = std::max(out, along ? std::abs(moved.dot(along_W_)) : moved.norm());
    }
    return out;
}

std::string AttemptMeasures::why_too_small() const {
    const double line = (attempt_.plan.to_W - attempt_.plan.from_W).norm();
    if (const double share = extent(false) / line; line > 0 && share < kLeastShare)
        return fmt::format("the movement covered {:.0f} % of the way, less than {:.0f} %",
                           100 * share, 100 * kLeastShare);
    const double lasted = static_cast<double>(end_ - onset_) * tick_;
    if (lasted < kLeastTime)
        return fmt::format("the movement lasted {:.0f} ms, less than {:.0f}", 1e3 * lasted,
                           1e3 * kLeastTime);
    return "";
}

std::string AttemptMeasures::why_no_index() const {
    const double line = (attempt_.plan.to_W - attempt_.plan.from_W).norm();
    if (const double share = extent(true) / line; !(share >= kIndexShare))
        return fmt::format("the movement covered {:.0f} % of the line, less than {:.0f} %",
                           100 * share, 100 * kIndexShare);
    const Values ideals = while_in_channel(ideal_);
    // time between the first and the last of these ticks
    const double lasted = (static_cast<double>(ideals.size()) - 1) * tick_;
    if (lasted < kIndexTime)
        return fmt::format("the movement lasted {:.0f} ms{}, less than {:.0f}", 1e3 * lasted,
                           ideals.size() < whole(ideal_).size() ? " in the channel" : "",
                           1e3 * kIndexTime);
    double square = 0;
    for (const double ideal : ideals) square += ideal * ideal;
    const double mean = std::sqrt(square / static_cast<double>(ideals.size()));
    if (!(mean >= kLeastIdeal))
        return fmt::format("the ideal force was {:.2g} N, less than {:g}", mean, kLeastIdeal);
    return "";
}

void AttemptMeasures::find_lines() {
    const auto late = std::lround(attempt_.plan.ideal_delay / tick_);
    for (const MotionSample& s : run_) {
        left_.push_back((s.p_W - attempt_.plan.from_W).dot(left_W_));
        force_.push_back(s.f_W.dot(left_W_));
        // the hand must push against the field, which may act late
        const std::ptrdiff_t before = &s - attempt_.samples.data();
        const Vec3 v_W = before < late ? Vec3(Vec3::Zero()) : (&s - late)->v_W;
        ideal_.push_back(-left_W_.dot(attempt_.plan.ideal * v_W));
    }
}

std::string AttemptMeasures::why_missing(const task::MeasureRow& row) const {
    using task::MeasureRow;
    if ((row.needs & MeasureRow::channel) && (attempt_.plan.channel == 0 || attempt_.share == 0))
        return "no channel";
    if (row.needs & MeasureRow::movement) {
        const std::string& why = row.needs & MeasureRow::begun ? no_onset_ : no_end_;
        if (why.empty() && (row.needs & MeasureRow::channel) && while_in_channel(force_).empty())
            return "no channel acted during the movement";
        return why.empty() && (row.needs & MeasureRow::ideal) ? why_no_index() : why;
    }
    if (row.needs & MeasureRow::step) return std::isnan(step_) ? "no load step" : "";
    return attempt_.lift == nullptr ? "no lift" : "";
}

/// Returns the reason why a value other than the first is missing.
std::string AttemptMeasures::why_in_part(const task::MeasureRow& row) const {
    return row.needs == task::kInChannel && !in_channel(peak_) ? "no channel acted at peak speed"
                                                               : "";
}

MeasuredValues AttemptMeasures::measure(const task::MeasureRow& row) const {
    using A = AttemptMeasures;
    struct Rule {
        const char* name;
        Values (*compute)(const A&);
        const char* otherwise;  // why the first value is missing; null if the lift's mark says so
    };
    static constexpr const char* kNever = "not to be computed";
    static constexpr const char* kAxis = "the axis lies along the line";
    static const Rule kRules[] = {
        {"reaction_time",
         [](const A& a) { return Values{a.continued_ ? kUnmeasured : a.time(a.onset_) - a.go_}; },
         "no go signal, or the movement began before its states"},
        {"movement_time", [](const A& a) { return Values{a.time(a.end_) - a.time(a.onset_)}; },
         kNever},
        {"peak_speed", [](const A& a) { return Values{a.speed_[a.peak_]}; }, kNever},
        {"time_of_peak_speed",
         [](const A& a) { return Values{a.time(a.peak_) - a.time(a.onset_)}; }, kNever},
        {"path_length", [](const A& a) { return Values{a.path_length()}; }, kNever},
        {"lateral_deviation", [](const A& a) { return a.lateral_deviation(); }, kAxis},
        {"early_lateral_deviation", [](const A& a) { return a.early_lateral_deviation(); },
         "the movement ended too soon after onset"},
        {"largest_lateral_deviation",
         [](const A& a) { return Values{largest_by_size(a.whole(a.left_))}; }, kAxis},
        {"end_point_error", [](const A& a) { return a.end_point_error(); }, kNever},
        {"initial_direction", [](const A& a) { return a.initial_direction(); },
         "the movement ended too soon after onset"},
        {"spectral_arc_length",
         [](const A& a) { return Values{spectral_arc_length(a.whole(a.speed_), a.tick_)}; },
         kNever},
        {"channel_force", [](const A& a) { return a.channel_force(); }, kAxis},
        {"adaptation_index", [](const A& a) { return a.adaptation_index(); }, "no ideal force"},
        {"grip_onset", [](const A& a) { return Values{a.lift().touch - a.go_}; }, nullptr},
        {"load_onset", [](const A& a) { return Values{a.lift().load_onset - a.go_}; }, nullptr},
        {"peak_grip",
         [](const A& a) {
             return Values{a.lift().peak_grip, a.lift().peak_grip_rate, a.lift().peak_load_rate};
         },
         nullptr},
        {"grip_load_r", [](const A& a) { return Values{a.lift().grip_load_r}; }, nullptr},
        {"grip_load_lag", [](const A& a) { return Values{a.lift().grip_load_lag}; }, nullptr},
        {"safety_margin", [](const A& a) { return Values{a.lift().safety_margin}; }, nullptr},
        {"grip_latency", [](const A& a) { return a.grip_latency(); }, "grip did not respond"}};
    static_assert(std::size(kRules) == std::size(task::kMeasureTable));

    MeasuredValues out{Values(columns_in(row), kUnmeasured), why_missing(row)};
    if (out.why.empty()) {
        const auto named = [&](const Rule& rule) { return std::string(rule.name) == row.name; };
        const Rule& rule = *std::find_if(std::begin(kRules), std::end(kRules), named);
        out.values = rule.compute(*this);
        if (std::isnan(out.values.front()))
            out.why = rule.otherwise != nullptr ? rule.otherwise : "lift: " + lift().mark;
    }
    if (out.why.empty()) out.why = why_in_part(row);
    // known even if there is no movement
    if (row.needs & task::MeasureRow::ideal)
        out.values.back() = attempt_.plan.field_share * attempt_.share;
    leave_out_nonsense(row, out);
    return out;
}

double AttemptMeasures::path_length() const {
    double sum = 0;
    for (size_t i = onset_; i < end_; ++i) sum += (run_[i + 1].p_W - run_[i].p_W).norm();
    return sum;
}

Values AttemptMeasures::lateral_deviation() const {
    double area = 0;  // integrated along the line by the trapezoidal rule
    for (size_t i = onset_; i < end_; ++i)
        area += (left_[i] + left_[i + 1]) / 2 * (run_[i + 1].p_W - run_[i].p_W).dot(along_W_);
    return {left_[onset_ + first_turn(whole(left_))], left_[peak_], area * kToMm2};
}

Values AttemptMeasures::early_lateral_deviation() const {
    const size_t at = onset_ + static_cast<size_t>(std::round(options_.deviation_after / tick_));
    return {at < std::min(end_ + 1, run_.size()) ? left_[at] : kUnmeasured};
}

Values AttemptMeasures::end_point_error() const {
    const Vec3 error = run_[end_].p_W - attempt_.plan.to_W;
    return {error.norm(), error.dot(along_W_), error.dot(left_W_)};
}

Values AttemptMeasures::initial_direction() const {
    const auto after = static_cast<size_t>(std::round(options_.direction_after / tick_));
    const size_t at = onset_ + after;
    if (at >= run_.size()) return {kUnmeasured};
    return {angle_about(attempt_.plan.axis_W, along_W_, run_[at].p_W - run_[onset_].p_W)};
}

Values AttemptMeasures::while_in_channel(const Values& of_run) const {
    Values out;
    for (size_t i = onset_; i <= end_; ++i) {
        if (in_channel(i)) out.push_back(of_run[i]);
    }
    return out;
}

Values AttemptMeasures::channel_force() const {
    double impulse = 0;
    for (size_t i = onset_; i < end_; ++i) {
        if (in_channel(i) && in_channel(i + 1))
            impulse += (force_[i] + force_[i + 1]) / 2 * (time(i + 1) - time(i));
    }
    return {largest_by_size(while_in_channel(force_)),
            in_channel(peak_) ? force_[peak_] : kUnmeasured, impulse};
}

Values AttemptMeasures::adaptation_index() const {
    const Regression of(while_in_channel(ideal_), while_in_channel(force_));
    return {of.through_zero, of.slope, of.offset, of.r2, kUnmeasured};
}

Values AttemptMeasures::grip_latency() const {
    const std::vector<MotionSample>& all = attempt_.samples;
    const auto at = [&](double from) {
        const auto found = std::find_if(all.begin(), all.end(), [&](const MotionSample& s) {
            return s.time >= from - tick_ / 2;
        });
        return static_cast<size_t>(found - all.begin());
    };
    const size_t step = at(step_);
    const size_t before = at(step_ - kGripBefore);
    if (static_cast<double>(step - before) * tick_ < kLeastGripBefore) return {kUnmeasured};
    const auto count = static_cast<double>(step - before);
    double mean = 0;
    double square = 0;
    for (size_t i = before; i < step; ++i) mean += all[i].grip / count;
    for (size_t i = before; i < step; ++i) square += std::pow(all[i].grip - mean, 2) / count;
    const double threshold = mean + std::max(kGripSpreads * std::sqrt(square), kLeastRise);
    const auto lasts = static_cast<size_t>(std::round(kGripLasts / tick_));
    size_t above = 0;
    for (size_t i = step; i < all.size() && all[i].phase == all[step].phase; ++i) {
        above = all[i].grip > threshold ? above + 1 : 0;
        if (above > lasts) return {all[i - lasts].time - step_};
    }
    return {kUnmeasured};
}

Stroke first_stroke(std::span<const double> speed) {
    constexpr double kLeast = 0.25;  // fraction of the largest speed
    constexpr double kFall = 0.2;    // fraction of the stroke's own peak speed
    constexpr double kRise = 0.1;    // fraction of the largest speed
    const double most = speed.empty() ? 0 : *std::max_element(speed.begin(), speed.end());
    Stroke out;
    for (size_t i = 0; i < speed.size() && most > 0; ++i) {
        if (speed[out.peak] >= kLeast * most && speed[out.end] <= (1 - kFall) * speed[out.peak] &&
            speed[i] - speed[out.end] >= kRise * most)
            return out;
        if (speed[i] > speed[out.peak]) {
            out.peak = out.end = i;
        } else if (speed[i] < speed[out.end]) {
            out.end = i;
        }
    }
    out.end = speed.empty() ? 0 : speed.size() - 1;
    return out;
}

size_t first_turn(std::span<const double> x) {
    constexpr double kLeast = 0.002;  // [m]
    constexpr double kShare = 0.1;    // fraction of the range
    if (x.empty()) return 0;
    const auto [least, most] = std::minmax_element(x.begin(), x.end());
    const double turn = std::max(kLeast, kShare * (*most - *least));
    size_t low = 0;
    size_t high = 0;
    for (size_t i = 0; i < x.size(); ++i) {
        if (x[i] > x[high]) high = i;
        if (x[i] < x[low]) low = i;
        if (x[high] - x[0] >= turn && x[high] - x[i] >= turn) return high;
        if (x[0] - x[low] >= turn && x[i] - x[low] >= turn) return low;
    }
    const auto size = [](double a, double b) { return std::abs(a) < std::abs(b); };
    return static_cast<size_t>(std::max_element(x.begin(), x.end(), size) - x.begin());
}

double spectral_arc_length(std::span<const double> speed, double tick) {
    constexpr double kHighest = 10;  // [Hz]
    constexpr double kLeastAmplitude = 0.05;
    constexpr int kPadding = 4;  // zero padding by a factor of 2^4
    if (speed.size() < 2) return kUnmeasured;
    const auto powers =
        static_cast<int>(std::ceil(std::log2(static_cast<double>(speed.size())))) + kPadding;
    const double step = 1 / (tick * std::ldexp(1.0, powers));  // spacing of the frequencies [Hz]
    // a speed is never negative, so its amplitude spectrum is largest at frequency 0
    const double most = std::accumulate(speed.begin(), speed.end(), 0.0);
    if (!(most > 0)) return kUnmeasured;
    Values amplitude;
    size_t last = 0;
    for (size_t k = 0; static_cast<double>(k) * step <= kHighest; ++k) {
        const double turn = 2 * std::numbers::pi * static_cast<double>(k) / std::ldexp(1.0, powers);
        double cosine = 0;
        double sine = 0;
        for (size_t i = 0; i < speed.size(); ++i) {
            cosine += speed[i] * std::cos(turn * static_cast<double>(i));
            sine += speed[i] * std::sin(turn * static_cast<double>(i));
        }
        amplitude.push_back(std::hypot(cosine, sine) / most);
        if (amplitude.back() >= kLeastAmplitude) last = k;
    }
    if (last == 0) return kUnmeasured;
    double length = 0;
    for (size_t k = 0; k < last; ++k)
        length += std::hypot(1 / static_cast<double>(last), amplitude[k + 1] - amplitude[k]);
    return -length;
}

}  // namespace dihaptic::analysis
