#include "task/file/procedure_spec.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/random.h"

namespace dihaptic::task {
namespace {

/// Maximum number of grid cells. A trial's answer is processed within a tick, which takes 0.3 ms
/// for the largest grid.
constexpr size_t kLargestGrid = 200'000;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// The range of levels given in the file; infinite if none is given.
struct Range {
    double least = -kInfinity;
    double most = kInfinity;
};

/// Returns the range given in the file. Called during a tick, so it must not allocate.
Range given_range(const ProcedureSpec& spec) {
    const auto limits = [](const auto& s) {
        return Range{s.lowest.value_or(-kInfinity), s.highest.value_or(kInfinity)};
    };
    if (spec.staircase) return limits(*spec.staircase);
    if (spec.quest) return limits(*spec.quest);
    if (spec.quest_plus) {
        const auto [least, most] =
            std::minmax(spec.quest_plus->levels.from, spec.quest_plus->levels.to);
        return {least, most};
    }
    if (!spec.constant || spec.constant->levels.empty()) return {};
    const auto [least, most] =
        std::minmax_element(spec.constant->levels.begin(), spec.constant->levels.end());
    return {*least, *most};
}

/// Returns the range of shares or of their logarithms; infinite if the level is a named number.
Range share_range(const ProcedureSpec& spec) {
    if (!spec.level.empty()) return {};
    return {spec.logarithmic ? -kInfinity : 0, spec.logarithmic ? 0.0 : 1.0};
}

/// Returns the number of cells in the grid of quest_plus, or 0 for other procedures.
size_t grid_cells(const ProcedureSpec& spec) {
    if (!spec.quest_plus) return 0;
    const QuestPlusSpec& s = *spec.quest_plus;
    return static_cast<size_t>(s.levels.count) * static_cast<size_t>(s.thresholds.count) *
           static_cast<size_t>(s.shapes.count) * static_cast<size_t>(s.lapses.count);
}

/// Reports levels outside the range of shares or of their logarithms.
void check_levels(const ProcedureSpec& spec, Diagnostics& diagnostics) {
    const Range share = share_range(spec);
    const auto within = [&](const char* key, double level) {
        if (level >= share.least && level <= share.most) return;
        diagnostics.error(
            spec.place, fmt::format("{}.{}", spec.kind(), key),
            fmt::format("reaches {:g}, but the limit for levels of a share is {:g}", level,
                        level > share.most ? share.most : share.least),
            spec.logarithmic
                ? "The share is 10^level, which is at most 1: make the perturbation stronger "
                  "instead."
                : "The level is the perturbation's share: make the perturbation stronger instead.");
    };
    if (spec.quest_plus) {
        within("levels", spec.quest_plus->levels.from);
        within("levels", spec.quest_plus->levels.to);
    }
    if (spec.staircase) {
        within("start", spec.staircase->start);
        within("lowest", spec.staircase->lowest.value_or(share.least));
        within("highest", spec.staircase->highest.value_or(share.most));
    }
    if (spec.quest) {
        within("lowest", spec.quest->lowest.value_or(share.least));
        within("highest", spec.quest->highest.value_or(share.most));
    }
    if (spec.constant) {
        for (const double level : spec.constant->levels) within("levels", level);
    }
}

/// Reports missing keys that a named number requires, and keys that only a named number can have.
void check_number(const ProcedureSpec& spec, Diagnostics& diagnostics) {
    if (spec.level.empty()) {
        if (spec.perturb.empty())
            diagnostics.error(spec.place, "perturb", "is missing, and so is 'level'",
                              "Name a perturbation, whose share the procedure then chooses, or a "
                              "number for use in formulas, e.g. level: mass_g.");
        if (spec.standard)
            diagnostics.error(spec.place, "standard",
                              "is only for a procedure with 'level'; this one chooses a share",
                              "Leave it out: without the procedure the share is 0.");
        return;
    }
    const Range range = given_range(spec);
    for (const auto& [key, given] : {std::pair{"lowest", range.least}, {"highest", range.most}}) {
        if (std::isfinite(given)) continue;
        diagnostics.error(spec.place, fmt::format("{}.{}", spec.kind(), key),
                          fmt::format("is missing as a limit of {}", spec.level),
                          "Give 'lowest' and 'highest', so that these trials can be checked.");
    }
}

/// Warns about levels at which trials can run but whose answers cannot be fitted.
void warn_of_levels(const ProcedureSpec& spec, Diagnostics& diagnostics) {
    const double lowest = spec.least();
    if (model::takes(spec.fitted(), lowest)) return;
    diagnostics.warning(
        spec.place, fmt::format("{}.sigmoid", spec.name),
        fmt::format("levels may reach {:g}, where a Weibull function is undefined: answers there "
                    "cannot be fitted",
                    lowest),
        spec.logarithmic ? "Use sigmoid: weibull_log10, the same function of the logarithm."
        : spec.staircase ? "Give the staircase a 'lowest' above 0, or use another sigmoid."
        : spec.constant  ? "Leave out levels that are not above 0, or use another sigmoid."
                         : "Start the levels above 0, or use another sigmoid.");
}

}  // namespace

double ProcedureSpec::least() const {
    return std::max(given_range(*this).least, share_range(*this).least);
}
double ProcedureSpec::most() const {
    return std::min(given_range(*this).most, share_range(*this).most);
}
double ProcedureSpec::share(double at) const {
    return logarithmic ? std::pow(10, at) : at;
}
const char* ProcedureSpec::kind() const {
    return staircase ? "staircase" : quest ? "quest" : quest_plus ? "quest_plus" : "constant";
}

Procedure make_procedure(const ProcedureSpec& spec, uint64_t seed) {
    if (spec.staircase) {
        const StaircaseSpec& s = *spec.staircase;
        StaircaseSettings settings;
        settings.down_after = s.down_after;
        settings.start = s.start;
        settings.steps_up = s.steps_up;
        settings.down_over_up = s.down_over_up;
        settings.lowest = spec.least();
        settings.highest = spec.most();
        settings.reversals = s.reversals;
        settings.skipped_reversals = s.skipped_reversals;
        settings.trials = spec.trials;
        return {Staircase(settings)};
    }
    if (spec.quest) {
        const QuestSpec& s = *spec.quest;
        return {Quest({s.prior_mean, s.prior_sd, s.target, s.slope, spec.guess, s.blind, s.grain,
                       s.cells, spec.trials})};
    }
    if (spec.constant) {
        Random random(seed, "levels of " + spec.name);
        return {Constant(spec.constant->levels, spec.trials, random)};
    }
    const QuestPlusSpec& s = spec.quest_plus.value();
    return {QuestPlus({spec.fitted(), s.levels.values(), s.thresholds.values(), s.shapes.values(),
                       s.lapses.values(), spec.guess, spec.guess_is_lapse, spec.trials})};
}

void check(const ProcedureSpec& spec, Diagnostics& diagnostics) {
    const int kinds = spec.staircase.has_value() + spec.quest.has_value() +
                      spec.quest_plus.has_value() + spec.constant.has_value();
    if (kinds != 1) {
        diagnostics.error(
            spec.place, spec.name,
            kinds == 0 ? "has no way to choose levels" : "has more than one way to choose levels",
            "Give it one of 'staircase', 'quest', 'quest_plus' and 'constant'.");
        return;
    }
    check_number(spec, diagnostics);
    for (const auto& [key, outcome] : {std::pair{"yes", &spec.yes}, {"no", &spec.no}}) {
        if (outcome->empty())
            diagnostics.error(spec.place, key, "is missing",
                              "Name the outcome, or give states an interval (1 or 2) and exits the "
                              "key 'chooses'.");
    }
    if (spec.yes == spec.no && !spec.yes.empty())
        diagnostics.error(spec.place, "no", "is the same outcome as for 'yes'",
                          "Name two different outcomes.");
    if (const size_t cells = grid_cells(spec); cells > kLargestGrid) {
        diagnostics.error(
            spec.place, "quest_plus",
            fmt::format("has a grid of {} values, but at most {} are allowed", cells, kLargestGrid),
            "Reduce one of the counts.");
        return;
    }
    check_levels(spec, diagnostics);
    if (spec.quest && !spec.logarithmic)
        diagnostics.error(spec.place, "logarithmic",
                          "must be set, since the levels of 'quest' are logarithms",
                          "Add logarithmic: yes.");
    warn_of_levels(spec, diagnostics);
    if (spec.quest && !spec.known_shape())
        diagnostics.warning(
            spec.place, fmt::format("{}.sigmoid", spec.name),
            "answers to 'quest' lie only near the threshold and cannot determine the shape of "
            "another function: the confidence interval would be too narrow",
            "Leave out 'sigmoid'.");
    try {
        make_procedure(spec, 0);
    } catch (const Error& e) {
        for (Problem problem : e.problems()) {
            problem.place = spec.place;
            problem.key = fmt::format("{}.{}", spec.kind(), problem.key);
            diagnostics.add({problem});
        }
    }
}

}  // namespace dihaptic::task
