#include "analysis/adaptation.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <span>

#include "analysis/report/statistics.h"
#include "task/plan/trials.h"

namespace dihaptic::analysis {
namespace {

constexpr size_t kFewTrials = 8;

using Trial = AdaptationCurve::Trial;
using rows::TrialFile;
using rows::TrialKind;
using rows::TrialRow;

/// Compensations in the trials for which `meant` returns true, in trial order.
template <class Meant>
std::vector<double> measured(const std::vector<Trial>& trials, Meant meant) {
    std::vector<double> out;
    for (const Trial& trial : trials) {
        if (meant(trial) && !std::isnan(trial.compensation)) out.push_back(trial.compensation);
    }
    return out;
}

/// Returns 100 ln(a / b), or NaN if a or b is not positive.
double in_percent(double a, double b) {
    return a > 0 && b > 0 ? 100 * std::log(a / b) : kUnmeasured;
}

/// Perturbations that differ by less than this are treated as equal [deg] or [%].
constexpr double kSame = 0.5;

using Stretch = AdaptationCurve::Stretch;
using Window = AdaptationCurve::Window;

Window window(std::span<const double> x) {
    const Sample of = sample(x);
    return {of.mean, of.mean_interval.low, of.mean_interval.high, of.count};
}

std::span<const double> first_of(const std::vector<double>& x, size_t count) {
    return std::span(x).first(std::min(count, x.size()));
}

std::span<const double> last_of(const std::vector<double>& x, size_t count) {
    return std::span(x).last(std::min(count, x.size()));
}

/// Mean of a minus mean of b, with Welch's confidence interval.
Window difference(std::span<const double> a, std::span<const double> b, double sign) {
    const Sample of_a = sample(a);
    const Sample of_b = sample(b);
    Window out;
    out.mean = sign * (of_a.mean - of_b.mean);
    out.trials = of_a.count + of_b.count;
    if (of_a.count < 2 || of_b.count < 2) return out;
    const double half = welch_half_width(of_a, of_b);
    out.low = out.mean - half;
    out.high = out.mean + half;
    return out;
}

std::vector<double> measured_kind(const Stretch& stretch, TrialKind kind) {
    return measured(stretch.trials, [&](const Trial& t) { return t.kind == kind; });
}

bool has_kind(const Stretch& s, TrialKind kind) {
    return std::any_of(s.trials.begin(), s.trials.end(),
                       [&](const Trial& t) { return t.kind == kind; });
}

bool is_perturbed(const Stretch& s) {
    return has_kind(s, TrialKind::perturbed);
}

/// Whether the stretch has perturbations of both signs, as when each trial draws its own
/// perturbation.
bool has_both_signs(const Stretch& s) {
    const auto any = [&](double sign) {
        return std::ranges::any_of(s.trials, [&](const Trial& t) {
            return t.kind == TrialKind::perturbed && sign * t.perturbation > kSame;
        });
    };
    return any(1) && any(-1);
}

/// Compensations that show learning in a block's trials of one kind: those measured in channel
/// trials or, if the session has no channels, in all trials.
std::vector<double> learned_in(const Stretch& stretch, TrialKind kind, bool in_channels) {
    if (!in_channels) return measured_kind(stretch, kind);
    return has_kind(stretch, kind) ? stretch.compensation : std::vector<double>{};
}

bool only_catches(const Stretch& s) {
    return std::all_of(s.trials.begin(), s.trials.end(),
                       [](const Trial& t) { return t.kind == TrialKind::catch_trial; });
}

/// Trial::under of the stretch's first perturbed trial for which it is not empty; "" if there is no
/// such trial.
std::string under(const Stretch& s) {
    for (const Trial& t : s.trials)
        if (t.kind == TrialKind::perturbed && !t.under.empty()) return t.under;
    return "";
}

/// Whether both stretches have the same perturbation, as far as the perturbations are known.
bool alike(const Stretch& a, const Stretch& b) {
    return under(a) == under(b) && std::abs(a.perturbation - b.perturbation) < kSame;
}

Window savings(const std::vector<Stretch>& stretches) {
    const auto learned = [](const Stretch& s) { return std::abs(s.perturbation) > kSame; };
    const auto first = std::find_if(stretches.begin(), stretches.end(), learned);
    if (first == stretches.end()) return {};
    bool between = false;  // whether a different perturbation, or no perturbation, came in between
    for (auto later = first + 1; later != stretches.end(); ++later) {
        const bool same = std::abs(later->perturbation - first->perturbation) < kSame;
        if (same && between) {
            return difference(first_of(later->compensation, kFewTrials),
                              first_of(first->compensation, kFewTrials),
                              std::copysign(1.0, first->perturbation));
        }
        between = between || !same;
    }
    return {};
}

Window rebound(const std::vector<Stretch>& stretches) {
    constexpr size_t kLast = 2;  // few, since compensation is still changing when a reversal ends
    double first = 0;
    for (size_t i = 1; i < stretches.size(); ++i) {
        const Stretch& before = stretches[i - 1];
        if (first == 0 && std::abs(before.perturbation) > kSame) first = before.perturbation;
        if (!stretches[i].clamp || first * before.perturbation >= 0) continue;
        const std::vector<double>& clamp = stretches[i].compensation;
        // without channels in the opposite field, the first trials of the clamp stand in for the
        // end of that field
        const auto from = before.compensation.empty() ? first_of(clamp, kLast)
                                                      : last_of(before.compensation, kLast);
        return difference(last_of(clamp, kFewTrials), from, std::copysign(1.0, first));
    }
    return {};
}

/// Takes an adaptation index from the row of an attempt. In a channel no error is visible; for a
/// trial without a channel, only the field is known.
void take_index(Trial& trial, double index, double field_share) {
    trial.compensation = 100 * index;
    trial.clamp = is_clamp(trial.kind) || std::isnan(field_share);
    trial.perturbation = trial.clamp ? 0 : 100 * field_share;
}

/// Sets the name of the measure of these curves, and sets their unit to percent.
void name_measure(std::vector<AdaptationCurve>& curves, const char* measure) {
    for (AdaptationCurve& curve : curves) {
        curve.unit = std::string(1, '%');
        curve.measure = measure;
    }
}

/// Sets the trial's values to NaN if it has a perturbation for which learning has no measure.
void leave_out_unmeasured(Trial& trial, double share) {
    if (share == 0) trial.under.clear();
    if (trial.under.empty()) return;
    trial.clamp = true;
    trial.perturbation = trial.compensation = kUnmeasured;
}

/// Takes an angle or an extent from a reach. Returns whether it was an extent.
bool take_reach(Trial& trial, const rows::TrialMeasures& reach) {
    const double way = reach.hand_extent_mm;
    double shown;
    if (std::isnan(way)) {
        const double hand = reach.hand_angle_deg;
        trial.compensation = -hand;
        shown = std::remainder(reach.shown_angle_deg - hand, 360);
    } else {
        trial.compensation = in_percent(reach.wanted_extent_mm, way);
        shown = in_percent(reach.shown_extent_mm, way);
    }
    // the person saw no error if the reach fell short, and not the true error in a clamp
    trial.clamp = is_clamp(trial.kind) || std::isnan(trial.compensation);
    trial.perturbation = trial.clamp ? 0 : shown;
    return !std::isnan(way);
}

}  // namespace

std::map<int, int> last_attempts(const TrialFile& trials) {
    std::map<int, int> out;
    for (const TrialRow& row : trials) {
        int& last = out[row.asked.trial];
        last = std::max(last, row.measures.attempt);
    }
    return out;
}

bool has_adaptation_index(const TrialFile& trials) {
    const auto index = trials.column(kAdaptationIndex);
    for (size_t i = 0; i < trials.size(); ++i) {
        if (!std::isnan(trials.number(i, index))) return true;
    }
    return false;
}

std::vector<AdaptationCurve::Stretch> AdaptationCurve::stretches() const {
    std::vector<Stretch> out;
    const std::string* block = nullptr;
    for (const Trial& trial : trials) {
        if (block == nullptr || *block != trial.block)
            out.push_back({trial.block, 0, true, {}, {}});
        block = &trial.block;
        Stretch& stretch = out.back();
        stretch.trials.push_back(trial);
        stretch.clamp = stretch.clamp && is_clamp(trial.kind);
        if (trial.kind == TrialKind::catch_trial) continue;
        if (std::abs(trial.perturbation) > std::abs(stretch.perturbation))
            stretch.perturbation = trial.perturbation;
        if (!std::isnan(trial.compensation)) stretch.compensation.push_back(trial.compensation);
    }
    return out;
}

bool AdaptationCurve::in_channels() const {
    return measure == kAdaptationIndex;
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

std::vector<AdaptationCurve::Block> AdaptationCurve::blocks() const {
    std::vector<Block> out;
    for (const Stretch& stretch : stretches()) {
        const auto own = measured(stretch.trials, [&](const Trial& t) {
            return t.kind != TrialKind::catch_trial &&
                   (in_channels() || stretch.clamp || !is_clamp(t.kind));
        });
        Block& block = out.emplace_back();
        block.name = stretch.block;
        block.first = window(first_of(own, kFewTrials));
        block.last = window(last_of(own, kFewTrials));
        block.catch_trials = window(measured_kind(stretch, TrialKind::catch_trial));
        if (!stretch.clamp && !in_channels())
            block.inserted_clamps =
                window(measured(stretch.trials, [](const Trial& t) { return is_clamp(t.kind); }));
    }
    return out;
}

AdaptationCurve::Windows AdaptationCurve::windows() const {
    const std::vector<Stretch> parts = stretches();
    Windows out;
    const auto first = std::find_if(parts.begin(), parts.end(), is_perturbed);
    std::vector<double> baseline;
    for (auto part = parts.begin(); part != first; ++part) {
        const auto own = learned_in(*part, TrialKind::baseline, in_channels());
        baseline.insert(baseline.end(), own.begin(), own.end());
    }
    out.baseline = window(baseline);
    const bool has_mean = first == parts.end() || !has_both_signs(*first);
    if (has_mean) {
        out.savings = savings(parts);
        out.rebound = rebound(parts);
    }
    if (first == parts.end()) return out;
    auto last = first;
    for (auto part = first; part != parts.end(); ++part) {
        if (is_perturbed(*part) && alike(*part, *first)) {
            last = part;
        } else if (!only_catches(*part)) {
            break;
        }
    }
    if (has_mean) {
        out.early =
            window(first_of(learned_in(*first, TrialKind::perturbed, in_channels()), kFewTrials));
        out.late =
            window(last_of(learned_in(*last, TrialKind::perturbed, in_channels()), kFewTrials));
    }
    std::vector<double> catches;
    for (auto part = first; has_mean && part != last + 1; ++part) {
        const auto own = measured_kind(*part, TrialKind::catch_trial);
        catches.insert(catches.end(), own.begin(), own.end());
    }
    out.catch_trials = window(catches);
    const auto clamp = std::find_if(first, parts.end(), [](const Stretch& s) { return s.clamp; });
    if (clamp != parts.end()) {
        out.clamp_first = window(first_of(clamp->compensation, kFewTrials));
        out.clamp_last = window(last_of(clamp->compensation, kFewTrials));
    }
    for (auto part = first; part != parts.end(); ++part) {
        const auto own = learned_in(*part, TrialKind::washout, in_channels());
        if (own.empty()) continue;
        out.washout_first = window(first_of(own, kFewTrials));
        break;
    }
    return out;
}

std::string AdaptationCurve::note() const {
    std::string what;
    for (const Trial& trial : trials) {
        if (trial.under.empty() || what.find(trial.under) != std::string::npos) continue;
        what += (what.empty() ? "" : ", ") + trial.under;
    }
    return what.empty() ? "" : "not measured under " + what;
}

std::string AdaptationCurve::mixed() const {
    const std::vector<Stretch> parts = stretches();
    const auto first = std::find_if(parts.begin(), parts.end(), is_perturbed);
    if (first == parts.end() || !has_both_signs(*first)) return "";
    return "no early, late, catch, savings or rebound: the perturbation has both signs in " +
           first->block;
}

void AdaptationCurve::Window::list(FigureLister& row, const std::string& name,
                                   const char* what) const {
    row(name, mean, "1", what);
    row(name + "_low", low, "1", "lower end of its 95 % interval, over these trials");
    row(name + "_high", high, "1", "upper end of that interval");
}

void AdaptationCurve::list_landmarks(FigureLister& row) const {
    const Windows w = windows();
    const bool known = !trials.empty() && (note().empty() || std::abs(perturbation()) > kSame);
    row("measure", measure, "", "angle, extent, adaptation_index, or the column of errors");
    row("unit", unit, "", "unit of the values below");
    row("perturbation", known ? perturbation() : kUnmeasured, "1",
        "perturbation that is largest in magnitude");
    w.baseline.list(row, "baseline", "mean of the baseline before the first perturbed block");
    w.early.list(row, "early", "first eight measured trials of the first perturbed block");
    w.late.list(
        row, "late",
        "last eight measured trials of the last of the consecutive blocks with that perturbation");
    w.catch_trials.list(row, "catch", "mean of the catch trials in these blocks");
    w.clamp_first.list(
        row, "clamp_first",
        "first eight measured trials of the first clamp block after the first perturbed one");
    w.clamp_last.list(row, "clamp_last", "last eight measured trials of the same clamp block");
    w.washout_first.list(
        row, "washout_first",
        "first eight measured trials of the first washout block after the first perturbed one");
    w.savings.list(row, "savings",
                   "relearning: mean of the first eight measured trials of the next block with the "
                   "first perturbation, after a block with another perturbation or none, less that "
                   "of its first block; positive: in the direction of the first perturbation");
    w.rebound.list(row, "rebound",
                   "mean of the last eight measured trials of the first clamp block after the "
                   "opposite perturbation, less that of the last two measured trials of the block "
                   "before it or, if none was measured there, of the clamp's first two; positive: "
                   "in the direction of the first perturbation");
    const auto is_shown = [&](const Trial& t) { return !in_channels() || t.clamp; };
    const auto counted_as = [&](bool missing) {
        return std::count_if(trials.begin(), trials.end(), [&](const Trial& t) {
            return is_shown(t) && std::isnan(t.compensation) == missing;
        });
    };
    row("measured", counted_as(false), "1",
        "trials with a compensation; if it is an adaptation index, only those in channels");
    row("left_out", counted_as(true), "1",
        "such trials without a compensation: repeated attempts, and trials for which not_measured "
        "gives a reason");
}

Table block_table(const std::vector<AdaptationCurve>& curves) {
    Table table;
    for (const AdaptationCurve& curve : curves) {
        for (const AdaptationCurve::Block& block : curve.blocks()) {
            FigureLister row;
            row("round", curve.round, "", "name");
            row("block", block.name, "", "name");
            row("unit", curve.unit, "", "unit of the values below");
            const auto list = [&](const std::string& name, const Window& of, const char* what) {
                of.list(row, name, what);
                row(name + "_trials", of.trials, "1", "number of trials measured");
            };
            list("first", block.first, "mean of at most the first eight trials");
            list("last", block.last, "mean of at most the last eight trials");
            list("catch", block.catch_trials, "mean of the catch trials");
            list("inserted_clamps", block.inserted_clamps, "mean of clamps among other trials");
            add_row(table, row);
        }
    }
    return table;
}

std::vector<AdaptationCurve> adaptation_curves(const TrialFile& trials,
                                               const Unmeasured& unmeasured) {
    std::vector<AdaptationCurve> curves;
    const std::map<int, int> last = last_attempts(trials);
    const bool by_index = has_adaptation_index(trials);
    const auto index = trials.column(kAdaptationIndex), field = trials.column(kFieldShare);
    bool any = false;
    bool extents = false;
    for (size_t i = 0; i < trials.size(); ++i) {
        const rows::AskedRow& asked = trials[i].asked;
        Trial trial;
        trial.number = asked.trial;
        trial.block = asked.block;
        trial.kind = kind_of(asked, unmeasured);
        if (by_index) {
            take_index(trial, trials.number(i, index), trials.number(i, field));
        } else {
            extents = take_reach(trial, trials[i].measures) || extents;
        }
        // the error in a repeated attempt is kept, but the compensation is not used
        if (trials[i].measures.attempt < last.at(trial.number)) trial.compensation = kUnmeasured;
        any = any || !std::isnan(trial.compensation);
        trial.under = unmeasured_in(asked.perturbation, unmeasured);
        if (trial.under.empty() && trial.kind == TrialKind::force_channel && !by_index)
            trial.under = kForceChannel;
        leave_out_unmeasured(trial, asked.share);
        if (curves.empty() || curves.back().round != asked.round)
            curves.emplace_back().round = asked.round;
        curves.back().trials.push_back(trial);
    }
    if (!any) curves.clear();
    if (by_index) name_measure(curves, kAdaptationIndex);
    if (extents) name_measure(curves, "extent");
    return curves;
}

std::vector<AdaptationCurve> error_curves(const TrialFile& trials, const std::string& column) {
    std::vector<AdaptationCurve> curves;
    const std::map<int, int> last = last_attempts(trials);
    const auto error = trials.column(column);
    for (size_t i = 0; i < trials.size(); ++i) {
        const rows::AskedRow& asked = trials[i].asked;
        std::string round = asked.round;
        if (!asked.condition.empty()) round += (round.empty() ? "" : ", ") + asked.condition;
        const auto own = [&](const AdaptationCurve& c) { return c.round == round; };
        auto curve = std::find_if(curves.begin(), curves.end(), own);
        if (curve == curves.end()) {
            curve = curves.emplace(curves.end());
            curve->round = round;
        }
        Trial& trial = curve->trials.emplace_back();
        trial.number = asked.trial;
        trial.block = asked.block;
        trial.kind = asked.kind;
        const bool acts = !asked.perturbation.empty() && !is_clamp(trial.kind);
        trial.perturbation = acts ? asked.share : 0;
        trial.compensation = trials.number(i, error);  // holds the error until it is replaced below
        // a person who did not move saw no error; a repeated attempt caused learning, but its
        // compensation is not used
        trial.clamp = is_clamp(trial.kind) || std::isnan(trial.compensation);
        if (trials[i].measures.attempt < last.at(trial.number)) trial.compensation = kUnmeasured;
    }
    name_measure(curves, column.c_str());
    for (AdaptationCurve& curve : curves) {
        curve.errors = scale_of_errors(curve.compensation(), curve.schedule());
        for (Trial& trial : curve.trials) {
            if (!curve.errors && trial.perturbation != 0)
                trial.under = "a perturbation that does not show in " + column;
            trial.compensation = curve.errors ? 100 * curve.errors->compensation(trial.perturbation,
                                                                                 trial.compensation)
                                              : kUnmeasured;
            trial.perturbation *= 100;
        }
    }
    return curves;
}

std::optional<AdaptationFits> fit_adaptation(const AdaptationCurve& curve) {
    constexpr size_t kLeast = 10;
    const auto all = [](const Trial&) { return true; };
    if (!curve.note().empty()) return std::nullopt;  // some of the errors are unknown
    if (std::abs(curve.perturbation()) < 1e-6 || measured(curve.trials, all).size() < kLeast)
        return std::nullopt;
    AdaptationFits fits;
    const double baseline = curve.windows().baseline.mean;
    fits.bias = std::isnan(baseline) ? 0 : baseline;
    std::vector<double> compensation = curve.compensation();
    for (double& x : compensation) x -= fits.bias;
    const auto schedule = curve.schedule();
    fits.single_rate = fit_single_rate(compensation, schedule);
    fits.two_rate = fit_two_rate(compensation, schedule);
    return fits;
}

std::vector<FittedParameter> parameters(const std::optional<AdaptationFits>& fits) {
    const TwoRateFit two = fits ? fits->two_rate : TwoRateFit{};
    const SingleRateFit one = fits ? fits->single_rate : SingleRateFit{};
    std::vector<FittedParameter> out;
    const auto add = [&](const char* name, const char* what, double value, const Interval& of) {
        out.push_back({name, what});
        if (fits) out.back() = {name, what, value, in_words(of)};
    };
    const auto& [fast, slow] = two.rates;
    add("A_fast", "two-rate: fast retention", fast.retention, two.retention_fast);
    add("B_fast", "two-rate: fast learning", fast.learning, two.learning_fast);
    add("A_slow", "two-rate: slow retention", slow.retention, two.retention_slow);
    add("B_slow", "two-rate: slow learning", slow.learning, two.learning_slow);
    add("A", "single-rate: retention", one.rate.retention, one.retention);
    add("B", "single-rate: learning", one.rate.learning, one.learning);
    return out;
}

void list_fits(FigureLister& row, const std::optional<AdaptationFits>& fits, bool in_full) {
    const std::vector<FittedParameter> all = parameters(fits);
    constexpr size_t kTwoRate = 4;
    for (size_t i = 0; i < all.size(); ++i) {
        if (i == kTwoRate)
            row("two_rate_sd", fits ? fits->two_rate.residual_sd : kUnmeasured, "1",
                "two-rate: standard deviation of the residuals");
        row(all[i].name, all[i].value, "1", all[i].what);
        if (in_full && i < kTwoRate)
            row(all[i].name + std::string("_95"), all[i].interval, "", "its profile interval");
    }
    if (in_full)
        row("single_rate_sd", fits ? fits->single_rate.residual_sd : kUnmeasured, "1",
            "single-rate: standard deviation of the residuals");
}

}  // namespace dihaptic::analysis
