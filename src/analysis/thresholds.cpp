#include "analysis/thresholds.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/diagnostics.h"
#include "base/field.h"
#include "base/unmeasured.h"

namespace dihaptic::analysis {
namespace {

constexpr int kResamples = 500;
constexpr size_t kLeast = 10;

model::Sigmoid sigmoid_of(const std::string& name) {
    const auto names = enum_names(model::Sigmoid{});
    const auto found = std::find(names.begin(), names.end(), name);
    return found == names.end() ? model::Sigmoid::normal
                                : static_cast<model::Sigmoid>(found - names.begin());
}

}  // namespace

double ThresholdTrack::share(double level) const {
    return logarithmic ? std::pow(10, level) : level;
}

std::string ThresholdTrack::what() const {
    return number.empty() ? "share of " + perturbation : number;
}

std::vector<ThresholdTrack> threshold_tracks(const CsvFile& trials, const CsvFile& procedures) {
    std::vector<ThresholdTrack> out;
    for (size_t p = 0; p < procedures.rows(); ++p) {
        ThresholdTrack& track = out.emplace_back();
        track.procedure = procedures.text(p, "procedure");
        track.kind = procedures.text(p, "kind");
        track.perturbation = procedures.text(p, "perturbation");
        track.number = procedures.text(p, "level");
        track.logarithmic = procedures.text(p, "logarithmic") == "yes";
        track.model.sigmoid = sigmoid_of(procedures.text(p, "sigmoid"));
        // recordings before version 0.2 have no such column
        const double shape = procedures.number(p, "shape");
        if (std::isfinite(shape)) track.model.shape = shape;
        track.model.guess = procedures.number(p, "guess");
        track.model.guess_is_lapse = procedures.text(p, "guess_is_lapse") == "yes";
        const std::string yes = procedures.text(p, "yes");
        const std::string no = procedures.text(p, "no");
        for (size_t i = 0; i < trials.rows(); ++i) {
            if (trials.text(i, "procedure") != track.procedure) continue;
            const std::string outcome = trials.text(i, "outcome");
            const double share = trials.number(i, track.number.empty() ? "share" : track.number);
            const double level = track.logarithmic ? std::log10(share) : share;
            if ((outcome != yes && outcome != no) || !std::isfinite(level)) continue;
            track.answers.push_back({level, outcome == yes});
            track.trials.push_back(trials.whole(i, "trial_num"));
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
