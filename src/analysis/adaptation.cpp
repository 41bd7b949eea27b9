#include "analysis/adaptation.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

namespace dihaptic::analysis {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr size_t kFew = 8;

using Trial = AdaptationCurve::Trial;

/// Compensations of the trials that are meant, in their order.
template <class Meant>
std::vector<double> measured(const std::vector<Trial>& trials, Meant meant) {
    std::vector<double> out;
    for (const Trial& trial : trials) {
        if (meant(trial) && !std::isnan(trial.compensation)) out.push_back(trial.compensation);
    }
    return out;
}

double mean(std::vector<double>::const_iterator first, std::vector<double>::const_iterator last) {
    double sum = 0;
    for (auto i = first; i != last; ++i) sum += *i;
    return first == last ? kNaN : sum / static_cast<double>(last - first);
}

double mean(const std::vector<double>& x) {
    return mean(x.begin(), x.end());
}

double mean_of_first(const std::vector<double>& x, size_t count) {
    return mean(x.begin(), x.begin() + static_cast<std::ptrdiff_t>(std::min(count, x.size())));
}

double mean_of_last(const std::vector<double>& x, size_t count) {
    return mean(x.end() - static_cast<std::ptrdiff_t>(std::min(count, x.size())), x.end());
}

/// 100 ln(a / b); NaN where one of them is not positive.
double in_percent(double a, double b) {
    return a > 0 && b > 0 ? 100 * std::log(a / b) : kNaN;
}

/// Perturbations that differ by less are the same [deg], [%].
constexpr double kSame = 0.5;

double savings(const std::vector<AdaptationCurve::Stretch>& stretches) {
    const auto learned = [](const AdaptationCurve::Stretch& s) {
        return std::abs(s.perturbation) > kSame;
    };
    const auto first = std::find_if(stretches.begin(), stretches.end(), learned);
    if (first == stretches.end()) return kNaN;
    bool between = false;  // something else was done
    for (auto later = first + 1; later != stretches.end(); ++later) {
        const bool same = std::abs(later->perturbation - first->perturbation) < kSame;
        if (same && between) {
            const double gain =
                mean_of_first(later->compensation, kFew) - mean_of_first(first->compensation, kFew);
            return std::copysign(1.0, first->perturbation) * gain;
        }
        between = between || !same;
    }
    return kNaN;
}

double rebound(const std::vector<AdaptationCurve::Stretch>& stretches) {
    constexpr size_t kLast = 2;  // a reversal is short, and goes on changing
    double first = 0;
    for (size_t i = 1; i < stretches.size(); ++i) {
        const AdaptationCurve::Stretch& before = stretches[i - 1];
        if (first == 0 && std::abs(before.perturbation) > kSame) first = before.perturbation;
        if (!stretches[i].clamp || first * before.perturbation >= 0) continue;
        const double change = mean_of_last(stretches[i].compensation, kFew) -
                              mean_of_last(before.compensation, kLast);
        return std::copysign(1.0, first) * change;
    }
    return kNaN;
}

/// The last attempt of each trial, which counts: the others were to be done again.
std::map<int, int> last_attempts(const CsvFile& trials) {
    std::map<int, int> out;
    for (size_t i = 0; i < trials.rows(); ++i) {
        int& last = out[static_cast<int>(trials.number(i, "trial_num"))];
        last = std::max(last, static_cast<int>(trials.number(i, "attempt")));
    }
    return out;
}

}  // namespace

std::vector<AdaptationCurve::Stretch> AdaptationCurve::stretches() const {
    std::vector<Stretch> out;
    const std::string* block = nullptr;
    for (const Trial& trial : trials) {
        if (block == nullptr || *block != trial.block) out.push_back({0, true, {}});
        block = &trial.block;
        Stretch& stretch = out.back();
        stretch.clamp = stretch.clamp && trial.kind == "error_clamp";
        if (trial.kind == "catch") continue;
        if (std::abs(trial.perturbation) > std::abs(stretch.perturbation))
            stretch.perturbation = trial.perturbation;
        if (!std::isnan(trial.compensation)) stretch.compensation.push_back(trial.compensation);
    }
    return out;
}

double AdaptationCurve::perturbation() const {
    double most = 0;
    for (const Trial& trial : trials) {
        if (std::abs(trial.perturbation) > std::abs(most)) most = trial.perturbation;
    }
    return most;
}

std::vector<double> AdaptationCurve::compensation() const {
    std::vector<double> out;
    for (const Trial& trial : trials) out.push_back(trial.compensation);
    return out;
}

std::vector<model::AdaptationTrial> AdaptationCurve::schedule() const {
    std::vector<model::AdaptationTrial> out;
    for (const Trial& trial : trials) out.push_back({trial.perturbation, trial.clamp});
    return out;
}

AdaptationCurve::Landmarks AdaptationCurve::landmarks() const {
    const auto of_kind = [&](const char* kind) {
        return measured(trials, [&](const Trial& t) { return t.kind == kind; });
    };
    const auto perturbed = of_kind("perturbed");
    const auto clamp = of_kind("error_clamp");
    const std::vector<Stretch> parts = stretches();
    return {mean(of_kind("baseline")),
            mean_of_first(perturbed, kFew),
            mean_of_last(perturbed, kFew),
            mean(of_kind("catch")),
            mean_of_first(clamp, kFew),
            mean_of_last(clamp, kFew),
            mean_of_first(of_kind("washout"), 1),
            savings(parts),
            rebound(parts)};
}

std::vector<Table::Cell> AdaptationCurve::landmark_cells() const {
    const Landmarks at = landmarks();
    return {
        unit,           perturbation(), at.baseline,      at.early,   at.late,   at.catch_trials,
        at.clamp_first, at.clamp_last,  at.washout_first, at.savings, at.rebound};
}

std::vector<Table::Column> landmark_columns() {
    return {{"unit", "of what follows"},
            {"perturbation", ""},
            {"baseline", "mean"},
            {"early", "first eight perturbed trials"},
            {"late", "last eight"},
            {"catch", "mean of the catch trials"},
            {"clamp_first", "first eight in the clamp"},
            {"clamp_last", "last eight"},
            {"washout_first", "first trial"},
            {"savings", "learning it again: first eight trials, less those of the first time"},
            {"rebound", "last eight of a clamp after the opposite, less what was before"}};
}

std::vector<AdaptationCurve> adaptation_curves(const CsvFile& trials) {
    std::vector<AdaptationCurve> curves;
    const std::map<int, int> last = last_attempts(trials);
    bool any = false;
    bool extents = false;
    for (size_t i = 0; i < trials.rows(); ++i) {
        Trial trial;
        trial.number = static_cast<int>(trials.number(i, "trial_num"));
        trial.block = trials.text(i, "block");
        trial.kind = trials.text(i, "kind");
        const double way = trials.number(i, "hand_extent_mm");
        double shown;
        if (std::isnan(way)) {
            const double hand = trials.number(i, "hand_angle_deg");
            trial.compensation = -hand;
            shown = std::remainder(trials.number(i, "shown_angle_deg") - hand, 360);
        } else {
            extents = true;
            trial.compensation = in_percent(trials.number(i, "wanted_extent_mm"), way);
            shown = in_percent(trials.number(i, "shown_extent_mm"), way);
        }
        // what was not reached was not seen to be wrong, and a clamp shows what it likes
        trial.clamp = trial.kind == "error_clamp" || std::isnan(trial.compensation);
        trial.perturbation = trial.clamp ? 0 : shown;
        // what was seen in an attempt that is done again was seen, but does not count
        if (trials.number(i, "attempt") < last.at(trial.number)) trial.compensation = kNaN;
        any = any || !std::isnan(trial.compensation);
        const std::string round = trials.text(i, "round");
        if (curves.empty() || curves.back().round != round) curves.push_back({round, "deg", {}});
        curves.back().trials.push_back(trial);
    }
    if (!any) curves.clear();
    if (extents) {
        for (AdaptationCurve& curve : curves) curve.unit = "%";
    }
    return curves;
}

std::optional<AdaptationFits> fit_adaptation(const AdaptationCurve& curve) {
    constexpr size_t kLeast = 10;
    const auto all = [](const Trial&) { return true; };
    if (std::abs(curve.perturbation()) < 1e-6 || measured(curve.trials, all).size() < kLeast)
        return std::nullopt;
    AdaptationFits fits;
    const double baseline = curve.landmarks().baseline;
    fits.bias = std::isnan(baseline) ? 0 : baseline;
    std::vector<double> compensation = curve.compensation();
    for (double& x : compensation) x -= fits.bias;
    const auto schedule = curve.schedule();
    fits.single_rate = fit_single_rate(compensation, schedule);
    fits.two_rate = fit_two_rate(compensation, schedule);
    return fits;
}

}  // namespace dihaptic::analysis
