#include "analysis/thresholds.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numeric>
#include <span>
#include <utility>

#include "base/diagnostics.h"
#include "base/unmeasured.h"
#include "task/procedures/staircase.h"

namespace dihaptic::analysis {
namespace {

constexpr int kResamples = 500;
constexpr size_t kLeast = 10;

}  // namespace

double ThresholdTrack::share(double level) const {
    return logarithmic ? std::pow(10, level) : level;
}

std::string ThresholdTrack::what() const {
    return number.empty() ? "share of " + perturbation : number;
}

std::vector<double> ThresholdTrack::reversals() const {
    std::vector<double> out;
    if (kind != "staircase" || answers.empty()) return out;
    // the levels alone do not show a reversal that ends a staircase, or one at a limit
    task::StaircaseSettings settings;
    settings.down_after = down_after;
    settings.trials = static_cast<int>(answers.size());
    task::Staircase staircase(settings);
    for (const Answer& answer : answers) staircase.answer(answer.level, answer.yes);
    for (const double level : staircase.reversals()) out.push_back(share(level));
    const auto skipped = std::min<size_t>(out.size(), static_cast<size_t>(skipped_reversals));
    out.erase(out.begin(), out.begin() + static_cast<std::ptrdiff_t>(skipped));
    return out;
}

double ThresholdTrack::weber_fraction(const model::Psychometric& function) const {
    constexpr double kForcedChoice = 0.25;
    if (number.empty() || !(standard > 0)) return kUnmeasured;
    if (function.guess >= kForcedChoice)
        return std::abs(share(function.threshold) - standard) / standard;
    model::Psychometric sigmoid = function;
    sigmoid.guess = sigmoid.lapse = 0;
    return std::abs(share(sigmoid.level(0.75)) - share(sigmoid.level(0.25))) / 2 / standard;
}

namespace {

/// Whether a single function describes the answers of both tracks.
bool belong_together(const ThresholdTrack& a, const ThresholdTrack& b) {
    const bool same_standard =
        a.standard == b.standard || (std::isnan(a.standard) && std::isnan(b.standard));
    return a.number == b.number && a.perturbation == b.perturbation &&
           a.logarithmic == b.logarithmic && same_standard && a.model.sigmoid == b.model.sigmoid &&
           a.model.shape == b.model.shape && a.model.guess == b.model.guess &&
           a.model.guess_is_lapse == b.model.guess_is_lapse;
}

/// Returns a track with all answers of the given tracks, in trial order.
ThresholdTrack pooled(const std::vector<const ThresholdTrack*>& tracks) {
    ThresholdTrack out = *tracks.front();
    out.kind = "all of these";
    std::vector<std::pair<int, Answer>> answers;
    std::string names;
    for (const ThresholdTrack* track : tracks) {
        names += (names.empty() ? "" : ", ") + track->procedure;
        for (size_t i = 0; i < track->answers.size(); ++i)
            answers.emplace_back(track->trials[i], track->answers[i]);
    }
    std::stable_sort(answers.begin(), answers.end(),
                     [](const auto& a, const auto& b) { return a.first < b.first; });
    out.procedure = names;
    out.trials.clear();
    out.answers.clear();
    for (const auto& [trial, answer] : answers) {
        out.trials.push_back(trial);
        out.answers.push_back(answer);
    }
    return out;
}

void add_pooled(std::vector<ThresholdTrack>& tracks) {
    const size_t count = tracks.size();
    std::vector<char> done(count, 0);
    std::vector<ThresholdTrack> out;
    for (size_t i = 0; i < count; ++i) {
        std::vector<const ThresholdTrack*> together;
        for (size_t j = i; j < count; ++j) {
            if (done[j] || !belong_together(tracks[i], tracks[j])) continue;
            together.push_back(&tracks[j]);
            done[j] = 1;
        }
        if (together.size() > 1) out.push_back(pooled(together));
    }
    std::move(out.begin(), out.end(), std::back_inserter(tracks));
}

}  // namespace

std::vector<ThresholdTrack> threshold_tracks(const rows::TrialFile& trials,
                                             const rows::ProcedureFile& procedures) {
    std::vector<ThresholdTrack> out;
    for (const rows::ProcedureRow& p : procedures) {
        ThresholdTrack& track = out.emplace_back();
        track.procedure = p.procedure;
        track.kind = p.kind;
        track.perturbation = p.perturbation;
        track.number = p.level;
        track.standard = p.standard;
        track.logarithmic = p.logarithmic;
        track.model.sigmoid = p.sigmoid;
        // recordings from before version 0.2 have no such column
        if (std::isfinite(p.shape)) track.model.shape = p.shape;
        track.model.guess = p.guess;
        track.model.guess_is_lapse = p.guess_is_lapse;
        const auto chosen = trials.column(p.level);
        for (size_t i = 0; i < trials.size(); ++i) {
            const rows::TrialRow& row = trials[i];
            if (row.asked.procedure != p.procedure) continue;
            const std::string& outcome = row.measures.outcome;
            const double share = p.level.empty() ? row.asked.share : trials.number(i, chosen);
            const double level = p.logarithmic ? std::log10(share) : share;
            if ((outcome != p.yes && outcome != p.no) || !std::isfinite(level)) continue;
            track.answers.push_back({level, outcome == p.yes});
            track.trials.push_back(row.asked.trial);
        }
    }
    add_pooled(out);
    return out;
}

void list_psychophysics(const ThresholdTrack& track, const model::Psychometric& function,
                        FigureLister& row) {
    const std::vector<double> reversals = track.reversals();
    const auto count = static_cast<double>(reversals.size());
    // of an odd number, the first is left out, so that peaks and valleys have equal weight
    const std::span<const double> even = std::span(reversals).subspan(reversals.size() % 2);
    const double sum = std::accumulate(even.begin(), even.end(), 0.0);
    const bool kind_is_staircase = track.kind == "staircase";
    row("threshold_probability", function.probability(function.threshold), "1",
        "probability of yes at the threshold, by the fitted function");
    row("weber_fraction", track.weber_fraction(function), "1",
        "just noticeable difference over the standard; the difference is the threshold's distance "
        "from the standard if the guess rate is 0.25 or more, otherwise half the distance between "
        "the quartiles");
    row("reversals", kind_is_staircase ? count : kUnmeasured, "1",
        "number of a staircase's reversals, without the skipped ones; empty for other procedures");
    row("mean_of_reversals", even.empty() ? kUnmeasured : sum / static_cast<double>(even.size()),
        "1",
        "mean level of the last even number of these reversals, in the unit of threshold_share");
}

ThresholdFit fit_threshold(const ThresholdTrack& track) {
    ThresholdFit out;
    const std::vector<LevelCount> counts = count(track.answers);
    if (track.answers.size() < kLeast) {
        out.note = fmt::format("not possible: {} answers, but a fit requires {}",
                               track.answers.size(), kLeast);
        return out;
    }
    try {
        out.fit = fit_psychometric(counts, track.model);
    } catch (const Error& e) {  // the other tracks may still be fitted
        out.note = "not possible: " + e.problems().front().what;
        return out;
    }
    const double t = out.fit->function.threshold;
    const double low = counts.front().level;
    const double high = counts.back().level;
    out.note = why_no_threshold(counts, *out.fit);
    if (out.note.empty() && (t < low || t > high)) {
        out.note =
            fmt::format("outside of the levels shown, {:.3g} to {:.3g}: a guess, not a measurement",
                        track.share(low), track.share(high));
    }
    return out;
}

PsychometricIntervals threshold_intervals(const ThresholdTrack& track, const PsychometricFit& fit) {
    return profile_intervals(count(track.answers), fit, track.model);
}

double deviance_share(const ThresholdTrack& track, const PsychometricFit& fit, uint64_t seed) {
    return deviance_share(count(track.answers), fit, track.model, kResamples, seed);
}

model::Psychometric ThresholdFit::function() const {
    if (fit) return fit->function;
    return {.threshold = kUnmeasured, .shape = kUnmeasured, .lapse = kUnmeasured};
}

}  // namespace dihaptic::analysis
