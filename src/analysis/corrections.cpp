#include "analysis/corrections.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "analysis/perturbations.h"
#include "analysis/savitzky_golay.h"
#include "analysis/trials.h"
#include "base/plural.h"

namespace dihaptic::analysis {
namespace {

constexpr double kShortestTrial = 0.3;      // length of the part of a trial that is used [s]
constexpr double kLongestTrial = 1;         // [s]
constexpr double kDerivativeWindow = 0.05;  // window for the derivative [s]
constexpr size_t kFewest = 3;               // trials
constexpr double kErrors = 3;              // the means must differ by this many standard errors ...
constexpr double kDifferenceLasts = 0.02;  // ... for this long [s]

/// Mean velocity at a tick, and its squared standard error.
struct MeanVelocity {
    double mean = 0;
    double variance = 0;
};

MeanVelocity mean_at(const std::vector<const Velocities*>& trials, size_t tick) {
    const auto n = static_cast<double>(trials.size());
    MeanVelocity out;
    for (const Velocities* v : trials) out.mean += (*v)[tick] / n;
    for (const Velocities* v : trials) {
        const double off = (*v)[tick] - out.mean;
        out.variance += off * off / (n - 1) / n;
    }
    return out;
}

/// Number of ticks that at least nine tenths of the trials have, but no less than kShortestTrial.
size_t most_have(const std::vector<const Velocities*>& trials, double tick) {
    std::vector<size_t> lengths;
    for (const Velocities* v : trials) lengths.push_back(v->size());
    std::ranges::sort(lengths);
    const auto least = static_cast<size_t>(std::llround(kShortestTrial / tick));
    return lengths.empty() ? least : std::max(least, lengths[lengths.size() / 10]);
}

/// Returns the trials that have at least this many ticks, and adds the number of shorter trials to
/// `left_out`.
std::vector<const Velocities*> long_enough(const std::vector<const Velocities*>& trials,
                                           size_t ticks, int& left_out) {
    std::vector<const Velocities*> out;
    for (const Velocities* v : trials) {
        if (v->size() < ticks) {
            ++left_out;
        } else {
            out.push_back(v);
        }
    }
    return out;
}

/// Position (between ticks) at which the curve last rises through `level` before `peak`; nullopt if
/// the curve is above `level` from the start.
std::optional<double> rises_through(const std::vector<double>& curve, double level, size_t peak) {
    for (size_t i = peak; i > 0; --i) {
        if (curve[i - 1] >= level) continue;
        const double share = (level - curve[i - 1]) / (curve[i] - curve[i - 1]);
        return static_cast<double>(i - 1) + share;
    }
    return std::nullopt;
}

/// The difference between the means and its standard error, for each tick.
struct Difference {
    std::vector<double> d;
    std::vector<double> error;
    std::optional<size_t> peak;  // tick at which the first excursion peaks

    /// Whether the means differ at a tick, in the direction of `sign`.
    bool differs(size_t i, double sign) const {
        return sign * d[i] > 0 && sign * d[i] >= kErrors * error[i];
    }
};

Difference difference(const std::vector<const Velocities*>& trials,
                      const std::vector<const Velocities*>& matched, size_t ticks) {
    Difference out;
    for (size_t i = 0; i < ticks; ++i) {
        const MeanVelocity with = mean_at(trials, i);
        const MeanVelocity without = mean_at(matched, i);
        out.d.push_back(with.mean - without.mean);
        out.error.push_back(std::sqrt(with.variance + without.variance));
    }
    return out;
}

/// Returns the tick at which the first excursion peaks: the means differ in one direction for 20
/// ms, and the difference then grows until it has fallen to half of its largest value. Later
/// excursions, such as the return after a jump that does not last, are ignored.
std::optional<size_t> first_peak(const Difference& of, double tick) {
    const auto lasts = static_cast<size_t>(std::llround(kDifferenceLasts / tick));
    size_t in_a_row = 0;
    double sign = 0;
    for (size_t i = 0; i < of.d.size(); ++i) {
        const double side = of.d[i] > 0 ? 1 : -1;
        in_a_row = of.differs(i, side) ? (side == sign ? in_a_row + 1 : 1) : 0;
        sign = side;
        if (in_a_row < lasts) continue;
        size_t peak = i;
        for (size_t k = i; k < of.d.size() && sign * of.d[k] > sign * of.d[peak] / 2; ++k) {
            if (sign * of.d[k] > sign * of.d[peak]) peak = k;
        }
        return peak;
    }
    return std::nullopt;
}

void find_latency(const Difference& found, double tick, rows::CorrectionRow& row) {
    const double sign = found.d[*found.peak] > 0 ? 1 : -1;
    std::vector<double> rise = savitzky_golay(found.d, tick, kDerivativeWindow, 1);
    for (double& a : rise) a *= sign;
    const auto last = rise.begin() + static_cast<std::ptrdiff_t>(*found.peak) + 1;
    const auto peak = static_cast<size_t>(std::max_element(rise.begin(), last) - rise.begin());
    row.acceleration = sign * rise[peak];
    const auto quarter = rises_through(rise, 0.25 * rise[peak], peak);
    const auto three = rises_through(rise, 0.75 * rise[peak], peak);
    if (!quarter || !three) {
        row.why = "the hand departs from the matched trials when the state begins, or earlier";
        return;
    }
    row.latency = (*quarter - (*three - *quarter) / 2) * tick;
}

}  // namespace

rows::CorrectionRow find_correction(const std::vector<const Velocities*>& trials,
                                    const std::vector<const Velocities*>& matched, double tick) {
    rows::CorrectionRow row;
    const size_t ticks = std::min({most_have(trials, tick), most_have(matched, tick),
                                   static_cast<size_t>(std::llround(kLongestTrial / tick))});
    const auto with = long_enough(trials, ticks, row.left_out);
    const auto without = long_enough(matched, ticks, row.left_out);
    row.trials = static_cast<int>(with.size());
    row.matched = static_cast<int>(without.size());
    if (with.size() < kFewest || without.size() < kFewest) {
        row.why = fmt::format("at least {} trials of each kind are needed", kFewest);
        return row;
    }
    row.compared = static_cast<double>(ticks) * tick;
    Difference found = difference(with, without, ticks);
    found.peak = first_peak(found, tick);
    if (!found.peak) {
        row.why = fmt::format("the means never differ by {:g} standard errors for {:g} ms", kErrors,
                              1e3 * kDifferenceLasts);
        return row;
    }
    row.velocity = found.d[*found.peak];
    row.at = static_cast<double>(*found.peak) * tick;
    row.error = found.error[*found.peak];
    find_latency(found, tick, row);
    return row;
}

std::optional<CorrectionFinder> CorrectionFinder::of(const recording::SessionFolder& folder,
                                                     const recording::LogHead& head,
                                                     const std::vector<std::string>& phases) try {
    const task::Task task = read_frozen_task(folder.file("task.yaml"));
    if (!task.corrections) return std::nullopt;
    CorrectionFinder out;
    out.spec_ = *task.corrections;
    const auto finger = std::ranges::find(head.fingers, std::string(out.spec_.of));
    if (!out.spec_.of.empty() && finger == head.fingers.end()) return std::nullopt;
    if (!out.spec_.of.empty()) out.finger_ = static_cast<size_t>(finger - head.fingers.begin());
    const auto phase = std::ranges::find(phases, std::string(out.spec_.after));
    if (phase == phases.end()) return std::nullopt;
    out.phase_ = static_cast<int>(phase - phases.begin());
    out.spec_.axis.normalize();
    out.tick_ = head.tick;
    for (const rows::AskedRow& row : rows::RowFile<rows::AskedRow>(folder.file("trial-list.csv")))
        out.asked_.push_back(row);
    return out;
} catch (const Error&) {
    return std::nullopt;
}

CorrectionFinder::Trial& CorrectionFinder::attempt_of(const frame::Frame& frame) {
    Trial& trial = trials_[frame.trial];
    if (trial.attempt != frame.task.attempt) {
        trial = {frame.task.attempt, false, true, {}};
        now_ = nullptr;
    }
    return trial;
}

void CorrectionFinder::add(const frame::Frame& frame) {
    const bool gap = frame.sequence != sequence_ + 1;
    sequence_ = frame.sequence;
    if (frame.trial < 1 || frame.phase < 1 || finger_ >= frame.fingers.size()) {
        now_ = nullptr;
        return;
    }
    Trial& trial = attempt_of(frame);
    if (gap) trial.whole = false;  // the state may have begun during the gap
    if (frame.phase == phase_ && trial.velocities.empty()) now_ = &trial;
    if (frame.task.outcome >= 0) trial.ended = true;
    if (now_ == nullptr || static_cast<double>(trial.velocities.size()) * tick_ >= kLongestTrial)
        return;
    const double v = spec_.axis.dot(frame.fingers[finger_].v_WH);
    if (std::isfinite(v)) trial.velocities.push_back(v);
}

const Velocities* CorrectionFinder::velocities_of(size_t i) const {
    // a partial perturbation counts as a different perturbation
    if (asked_[i].kind == rows::TrialKind::practice || asked_[i].share != 1) return nullptr;
    const auto found = trials_.find(static_cast<int>(i) + 1);
    if (found == trials_.end()) return nullptr;
    const Trial& trial = found->second;
    return trial.ended && trial.whole && !trial.velocities.empty() ? &trial.velocities : nullptr;
}

bool CorrectionFinder::is_matched(const rows::AskedRow& row, const std::string& condition) const {
    if (spec_.matched.empty()) return row.perturbation.empty() && row.condition == condition;
    return std::ranges::find(spec_.matched, row.condition) != spec_.matched.end();
}

std::string CorrectionFinder::matched_perturbation(const Group& group) const {
    for (const rows::AskedRow& row : asked_) {
        if (row.round == group.round && row.perturbation == group.perturbation &&
            is_matched(row, group.condition))
            return group.perturbation;
    }
    return "";
}

std::vector<CorrectionFinder::Group> CorrectionFinder::groups() const {
    std::vector<Group> out;
    for (const rows::AskedRow& row : asked_) {
        Group group{row.round, row.condition, row.perturbation};
        if (row.kind == rows::TrialKind::practice || is_matched(row, row.condition)) continue;
        if (std::ranges::find(out, group) == out.end()) out.push_back(std::move(group));
    }
    return out;
}

std::vector<rows::CorrectionRow> CorrectionFinder::rows() const {
    std::vector<rows::CorrectionRow> out;
    for (const Group& group : groups()) {
        std::vector<const Velocities*> trials, matched;
        const std::string without = matched_perturbation(group);
        for (size_t i = 0; i < asked_.size(); ++i) {
            const rows::AskedRow& row = asked_[i];
            const Velocities* const velocities = velocities_of(i);
            if (velocities == nullptr || row.round != group.round) continue;
            if (is_matched(row, group.condition)) {
                if (row.perturbation == without) matched.push_back(velocities);
            } else if (Group{row.round, row.condition, row.perturbation} == group) {
                trials.push_back(velocities);
            }
        }
        rows::CorrectionRow row = find_correction(trials, matched, tick_);
        row.round = group.round;
        row.condition = group.condition;
        row.perturbation = group.perturbation;
        out.push_back(std::move(row));
    }
    return out;
}

}  // namespace dihaptic::analysis
