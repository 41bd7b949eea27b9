#include "task/procedure_spec.h"

#include <fmt/format.h>

#include <algorithm>

namespace dihaptic::task {
namespace {

/// A trial's answer is processed within a tick, which takes 0.3 ms for the largest grid.
constexpr size_t kLargestGrid = 200'000;

/// The lowest level that the procedure's trials may have.
double lowest_level(const ProcedureSpec& spec) {
    if (spec.staircase) return spec.staircase->lowest.value_or(spec.least());
    if (spec.quest_plus) return std::min(spec.quest_plus->levels.from, spec.quest_plus->levels.to);
    return spec.least();
}

/// Number of cells of quest_plus's grid; 0 for the other procedures.
size_t grid_cells(const ProcedureSpec& spec) {
    if (!spec.quest_plus) return 0;
    const QuestPlusSpec& s = *spec.quest_plus;
    return static_cast<size_t>(s.levels.count) * static_cast<size_t>(s.thresholds.count) *
           static_cast<size_t>(s.shapes.count) * static_cast<size_t>(s.lapses.count);
}

/// Reports levels outside the range of shares, or of their logarithms.
void check_levels(const ProcedureSpec& spec, Diagnostics& diagnostics) {
    const auto within = [&](const char* key, double level) {
        if (level >= spec.least() && level <= spec.most()) return;
        diagnostics.error(spec.place, fmt::format("{}.{}", spec.kind(), key),
                          fmt::format("goes to {:g}, where levels of a share end at {:g}", level,
                                      level > spec.most() ? spec.most() : spec.least()),
                          spec.logarithmic
                              ? "The share is 10^level, at most 1: raise the perturbation instead."
                              : "The level is the perturbation's share: raise that instead.");
    };
    if (spec.quest_plus) {
        within("levels", spec.quest_plus->levels.from);
        within("levels", spec.quest_plus->levels.to);
    }
    if (spec.staircase) {
        within("start", spec.staircase->start);
        within("lowest", spec.staircase->lowest.value_or(spec.least()));
        within("highest", spec.staircase->highest.value_or(spec.most()));
    }
}

/// Warns of levels with which the experiment runs but its answers cannot be fitted.
void warn_of_levels(const ProcedureSpec& spec, Diagnostics& diagnostics) {
    const double lowest = lowest_level(spec);
    if (model::takes(spec.sigmoid, lowest)) return;
    diagnostics.warning(
        spec.place, fmt::format("{}.sigmoid", spec.name),
        fmt::format("levels may go to {:g}, where a Weibull function has no value: answers there "
                    "cannot be fitted",
                    lowest),
        spec.logarithmic ? "Take sigmoid: weibull_log10, which is the same of logarithms."
        : spec.staircase ? "Give the staircase a 'lowest' above 0, or take another sigmoid."
                         : "Let the levels begin above 0, or take another sigmoid.");
}

}  // namespace

Procedure make_procedure(const ProcedureSpec& spec) {
    if (spec.staircase) {
        const StaircaseSpec& s = *spec.staircase;
        StaircaseSettings settings;
        settings.down_after = s.down_after;
        settings.start = s.start;
        settings.steps_up = s.steps_up;
        settings.down_over_up = s.down_over_up;
        settings.lowest = s.lowest.value_or(spec.least());
        settings.highest = s.highest.value_or(spec.most());
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
    const QuestPlusSpec& s = spec.quest_plus.value();
    return {QuestPlus({spec.sigmoid, s.levels.values(), s.thresholds.values(), s.shapes.values(),
                       s.lapses.values(), spec.guess, spec.guess_is_lapse, spec.trials})};
}

void check(const ProcedureSpec& spec, Diagnostics& diagnostics) {
    const int kinds =
        spec.staircase.has_value() + spec.quest.has_value() + spec.quest_plus.has_value();
    if (kinds != 1) {
        diagnostics.error(
            spec.place, spec.name,
            kinds == 0 ? "has no way to choose levels" : "has more than one way to choose levels",
            "Give it one of staircase, quest and quest_plus.");
        return;
    }
    if (spec.yes == spec.no)
        diagnostics.error(spec.place, "no", "is the same outcome as yes", "Name two outcomes.");
    if (const size_t cells = grid_cells(spec); cells > kLargestGrid) {
        diagnostics.error(
            spec.place, "quest_plus",
            fmt::format("has a grid of {} values, where {} are the most", cells, kLargestGrid),
            "Lower a count.");
        return;
    }
    check_levels(spec, diagnostics);
    if (spec.quest && !spec.logarithmic)
        diagnostics.error(spec.place, "logarithmic", "quest's levels are logarithms",
                          "Add logarithmic: yes.");
    warn_of_levels(spec, diagnostics);
    try {
        make_procedure(spec);
    } catch (const Error& e) {
        for (Problem problem : e.problems()) {
            problem.place = spec.place;
            problem.key = fmt::format("{}.{}", spec.kind(), problem.key);
            diagnostics.add({problem});
        }
    }
}

}  // namespace dihaptic::task
