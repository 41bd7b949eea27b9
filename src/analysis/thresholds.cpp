#include "analysis/thresholds.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/diagnostics.h"
#include "base/unmeasured.h"

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

std::vector<ThresholdTrack> threshold_tracks(const rows::TrialFile& trials,
                                             const rows::ProcedureFile& procedures) {
    std::vector<ThresholdTrack> out;
    for (const rows::ProcedureRow& p : procedures) {
        ThresholdTrack& track = out.emplace_back();
        track.procedure = p.procedure;
        track.kind = p.kind;
        track.perturbation = p.perturbation;
        track.number = p.level;
        track.logarithmic = p.logarithmic;
        track.model.sigmoid = p.sigmoid;
        // recordings before version 0.2 have no such column
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
    return out;
}

ThresholdFit fit_threshold(const ThresholdTrack& track) {
    ThresholdFit out;
    const std::vector<LevelCount> counts = count(track.answers);
    if (track.answers.size() < kLeast) {
        out.note = fmt::format("not possible: {} answers, and a fit takes {}", track.answers.size(),
                               kLeast);
        return out;
    }
    try {
        out.fit = fit_psychometric(counts, track.model);
    } catch (const Error& e) {  // other tracks may still be fitted
        out.note = "not possible: " + e.problems().front().what;
        return out;
    }
    const double t = out.fit->function.threshold;
    const double low = counts.front().level;
    const double high = counts.back().level;
    out.outside = t < low || t > high;
    if (out.outside) {
        out.note =
            fmt::format("outside of the levels shown, {:.3g} to {:.3g}: a guess, no measurement",
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
