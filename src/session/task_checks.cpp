#include "session/task_checks.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <limits>
#include <optional>
#include <set>
#include <string_view>

#include "base/text_file.h"
#include "task/plan/measures.h"

namespace dihaptic::session {
namespace {

using task::Exit;
using task::State;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kRounding = 1e-9;  // [s]
/// Distance from the world's origin that no device reaches, on whatever table it stands [m].
constexpr double kOutOfReach = 1.5;

/// Longest duration of a state [s]: infinite if it may last for any time, unset if it varies
/// between trials.
std::optional<double> longest(const State& state) {
    double out = kInfinity;
    for (const Exit& exit : state.exits) {
        if (exit.when != task::When::time) continue;
        if (exit.hold.computed()) return std::nullopt;
        out = std::min(out, exit.hold.value);
    }
    return out;
}

void check_holds(const State& state, Diagnostics& diagnostics) {
    const std::optional<double> most = longest(state);
    if (!most) return;
    for (const Exit& exit : state.exits) {
        if (exit.when == task::When::time || exit.hold.computed()) continue;
        if (exit.hold.value < *most) continue;
        diagnostics.warning(
            exit.place, "hold",
            fmt::format("is {:g} s, but the state {} ends after {:g} s, so that this exit is never "
                        "taken",
                        exit.hold.value, state.name, *most),
            "Let the state last longer, or hold for less time.");
    }
}

class Ticks {
  public:
    Ticks(double tick, Diagnostics& diagnostics) : tick_(tick), diagnostics_(diagnostics) {}

    /// Warns of a time that is too short to be kept.
    void check(const Place& place, const char* key, double time) {
        if (time <= 0 || time > tick_ - kRounding) return;
        diagnostics_.warning(place, key,
                             fmt::format("is {:g} ms, less than a tick, and becomes one tick of "
                                         "{:g} ms",
                                         time * 1e3, tick_ * 1e3),
                             "Check its unit.");
    }
    void check(const Place& place, const char* key, const Formula& time) {
        if (!time.computed()) check(place, key, time.value);
    }

  private:
    double tick_;
    Diagnostics& diagnostics_;
};

void check_ticks(const task::Task& task, double tick, Diagnostics& diagnostics) {
    Ticks ticks(tick, diagnostics);
    for (const State& state : task.states) {
        for (const Exit& exit : state.exits)
            ticks.check(exit.place, exit.when == task::When::time ? "after" : "hold", exit.hold);
        for (const task::HandStep& step : state.hand)
            ticks.check(step.place, "duration", step.duration);
    }
    for (const task::PerturbationSpec& spec : task.perturbations) {
        if (!spec.profile) continue;
        ticks.check(spec.profile->place, "delay", spec.profile->delay);
        ticks.check(spec.profile->place, "rise", spec.profile->rise);
        ticks.check(spec.profile->place, "plateau", spec.profile->plateau.value_or(Formula(0)));
        ticks.check(spec.profile->place, "fall", spec.profile->fall);
    }
}

/// Whether a trial can come back to a state.
bool has_loop(const task::Task& task) {
    for (size_t i = 0; i < task.states.size(); ++i) {
        for (const Exit& exit : task.states[i].exits) {
            const auto to = std::find_if(task.states.begin(), task.states.end(),
                                         [&](const State& s) { return s.name == exit.to; });
            if (to != task.states.end() && to - task.states.begin() <= static_cast<ptrdiff_t>(i))
                return true;
        }
    }
    return false;
}

/// Warns of a perturbation whose delay is longer than a trial can last.
void check_delays(const task::Task& task, Diagnostics& diagnostics) {
    if (has_loop(task)) return;
    double all = 0;
    for (const State& state : task.states) all += longest(state).value_or(kInfinity);
    for (const task::PerturbationSpec& spec : task.perturbations) {
        if (!spec.profile || spec.profile->delay.computed() || spec.profile->delay.value < all)
            continue;
        diagnostics.warning(
            spec.profile->place, "delay",
            fmt::format("is {:g} s, but all states together last {:g} s at most, so that {} never "
                        "acts",
                        spec.profile->delay.value, all, spec.name),
            "Give a shorter delay; it counts from entry into the first of its states.");
    }
}

/// Names of the regions to which a hand has to come; others may only give a direction.
std::set<std::string> reached(const task::Task& task) {
    std::set<std::string> out;
    for (const State& state : task.states) {
        for (const Exit& exit : state.exits) {
            if (exit.when == task::When::inside) out.insert(exit.region);
        }
        for (const task::HandStep& step : state.hand) out.insert(step.reach);
    }
    return out;
}

void check_places(const task::TaskPlan& plan, Diagnostics& diagnostics) {
    const std::set<std::string> to_reach = reached(plan.task);
    std::set<std::string> told;
    for (const task::TaskPlan::Cell& cell : plan.cells) {
        for (size_t i = 0; i < cell.regions.size(); ++i) {
            const task::Region& region = cell.regions[i];
            const double away = cell.p_W[i].norm();
            if (!(away > kOutOfReach) || !to_reach.contains(region.name)) continue;
            if (!told.insert(region.name).second) continue;
            diagnostics.warning(
                region.place, region.name,
                fmt::format("lies {:.3g} m from the origin, where no device reaches", away),
                "Check the unit of its position.");
        }
    }
}

/// Counts the words of a text that are this name, apart from those in comments.
int count_of(std::string_view text, const std::string& name) {
    const auto in_word = [](char c) {
        return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_' || c == '-';
    };
    int out = 0;
    size_t i = 0;
    for (size_t at = text.find(name); at != std::string_view::npos; at = text.find(name, i)) {
        i = at + name.size();
        const std::string_view line = text.substr(0, at);
        const std::string_view before = line.substr(line.rfind('\n') + 1);
        const bool comment = before.find(" #") != std::string_view::npos || before.starts_with('#');
        const bool begins = at == 0 || !in_word(text[at - 1]);
        const bool ends = i >= text.size() || !in_word(text[i]);
        if (begins && ends && !comment) ++out;
    }
    return out;
}

/// Whether a file names a factor elsewhere than at its own place, with its unit or without.
bool is_used(std::string_view text, const std::string& factor) {
    if (count_of(text, factor) > 1) return true;
    for (size_t i = factor.find('_'); i != std::string::npos; i = factor.find('_', i + 1)) {
        if (count_of(text, factor.substr(0, i)) > 0) return true;
    }
    return false;
}

/// Whether a condition that is named like a level of the factor says what that level changes.
/// Conditions that 'cross' generates have such names, too, but change nothing themselves.
bool extends_condition(const task::Task& task, const task::Factor& factor) {
    return std::ranges::any_of(task.conditions, [&](const task::Condition& condition) {
        const bool changes = !condition.object.empty() || !condition.places.empty() ||
                             !condition.regions.empty() || !condition.perturbations.empty() ||
                             !condition.look.empty();
        return changes && std::ranges::count(factor.levels, condition.name) > 0;
    });
}

/// Warns of factors whose only mention in the file is their own. Perturbations that no block names
/// are often kept for later.
void check_uses(const task::Task& task, Diagnostics& diagnostics) {
    if (task.place.file.empty()) return;
    std::string text;
    try {
        text = read_text_file(task.place.file);
    } catch (const Error&) {
        return;  // it has been read before, and may be a pipe
    }
    for (const task::Factor& factor : task.cross) {
        if (factor.levels.size() < 2) {
            diagnostics.warning(factor.place, factor.factor, "is a factor with a single level",
                                "Give it several levels, or leave it out.");
            continue;
        }
        if (is_used(text, factor.factor) || extends_condition(task, factor)) continue;
        diagnostics.warning(factor.place, factor.factor,
                            "is a factor that nothing in this file uses: trials of its levels are "
                            "all the same",
                            "Name it in a formula, a text or a condition.");
    }
}

/// Warns of a learned field whose direction is reversed in some trials: each trial is related to
/// its own field, so that learning of one shows as learning of the other.
void check_ideal(const Plan& plan, Diagnostics& diagnostics) {
    const task::Task& task = plan.task->task;
    if (std::ranges::count(task.measures, "adaptation_index") == 0 || !task.movement) return;
    Mat3 first = Mat3::Zero();
    for (const task::MovementPlan& movement : task::movements_of(*plan.task, plan.scene)) {
        if (first.isZero(0)) first = movement.ideal;
        if (first.cwiseProduct(movement.ideal).sum() >= 0) continue;
        diagnostics.warning(
            task.movement->place, "ideal",
            "is a field whose direction differs between trials: adaptation_index, field_share and "
            "fits relate each trial to its own field, as if all fields were one",
            "To relate all trials to one field, name a perturbation with a fixed direction; no "
            "block has to use it.");
        return;
    }
}

}  // namespace

void check_task(const Plan& plan, Diagnostics& diagnostics) {
    if (!plan.task) return;
    const task::Task& task = plan.task->task;
    for (const State& state : task.states) check_holds(state, diagnostics);
    check_ticks(task, plan.settings.tick(), diagnostics);
    check_delays(task, diagnostics);
    check_places(*plan.task, diagnostics);
    check_uses(task, diagnostics);
    check_ideal(plan, diagnostics);
}

}  // namespace dihaptic::session
