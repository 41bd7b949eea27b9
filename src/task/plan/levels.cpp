#include "task/plan/levels.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "task/plan/lookup.h"

namespace dihaptic::task {
namespace {

bool has_state_of(const Task& task, int interval) {
    return std::any_of(task.states.begin(), task.states.end(),
                       [&](const State& state) { return state.interval == interval; });
}

void check_order(const Task& task, Diagnostics& diagnostics) {
    for (const int interval : {1, 2}) {
        if (has_state_of(task, interval)) continue;
        diagnostics.error(
            task.states.front().place, "interval",
            fmt::format("no state has interval {}, but other states have an interval", interval),
            fmt::format("Add interval: {} to the states of that interval.", interval));
    }
    for (const DrawSpec& draw : task.draws) {
        if (draw.name != kComparisonInterval) continue;
        const std::set<std::string> values(draw.values().begin(), draw.values().end());
        if (values == std::set<std::string>{"1", "2"}) continue;
        diagnostics.error(
            draw.place, "name",
            fmt::format("'{}' is reserved for the comparison interval", draw.name),
            "Draw it with 'choice' or 'permutation' from [1, 2], or give the draw another name.");
    }
}

/// Whether every trial of the block has a procedure that chooses this number.
bool chooses_always(const Task& task, const Block& block, const std::string& level) {
    const auto chooses = [&](const std::string& name) {
        return std::any_of(task.procedures.begin(), task.procedures.end(),
                           [&](const auto& p) { return p.name == name && p.level == level; });
    };
    return !block.procedures.empty() && block.insert.empty() &&
           std::all_of(block.procedures.begin(), block.procedures.end(), chooses);
}

/// Reports missing standards, and standards that differ for the same number.
void check_standards(const Task& task, Diagnostics& diagnostics) {
    std::set<std::string> seen;
    for (const ProcedureSpec& first : task.procedures) {
        if (first.level.empty() || !seen.insert(first.level).second) continue;
        std::optional<double> standard;
        for (const ProcedureSpec& p : task.procedures) {
            if (p.level != first.level || !p.standard) continue;
            if (standard && *standard != *p.standard)
                diagnostics.error(
                    p.place, "standard",
                    fmt::format("is {:g}, but another procedure has {:g} for {}", *p.standard,
                                *standard, p.level),
                    "Give both the same standard, or use two numbers with different names.");
            standard = p.standard;
        }
        const bool always =
            !has_intervals(task) &&
            std::all_of(task.blocks.begin(), task.blocks.end(), [&](const Block& block) {
                return chooses_always(task, block, first.level);
            });
        if (standard || always) continue;
        diagnostics.error(
            first.place, "standard",
            fmt::format("is missing: the value of {} where no procedure chooses it", first.level),
            "Add e.g. standard: 0.4; it applies in the other interval, and in trials without the "
            "procedure.");
    }
}

}  // namespace

bool has_intervals(const Task& task) {
    return has_state_of(task, 1) || has_state_of(task, 2);
}

void complete_intervals(Task& task, Diagnostics& diagnostics) {
    check_standards(task, diagnostics);
    if (!has_intervals(task)) return;
    const std::vector<std::string> draws = names_of(task.draws);
    if (std::find(draws.begin(), draws.end(), kComparisonInterval) == draws.end()) {
        DrawSpec& order = task.draws.emplace_back();
        order.name = kComparisonInterval;
        order.choice = {"1", "2"};
        order.place = task.place;
    }
    check_order(task, diagnostics);
    for (ProcedureSpec& procedure : task.procedures) {
        if (procedure.yes.empty()) procedure.yes = kComparison;
        if (procedure.no.empty()) procedure.no = kStandard;
    }
}

std::vector<LevelName> levels_of(const Task& task) {
    std::vector<LevelName> out;
    for (const ProcedureSpec& p : task.procedures) {
        if (p.level.empty()) continue;
        const auto same = [&](const LevelName& l) { return l.name == p.level; };
        auto found = std::find_if(out.begin(), out.end(), same);
        if (found == out.end()) {
            out.push_back({p.level, p.share(p.least()), {}, p.place});
            found = out.end() - 1;
        }
        if (p.standard) found->standard = *p.standard;
        std::vector<double>& values = found->values;
        values.insert(values.end(), {p.share(p.least()), p.share(p.most())});
        if (!p.constant) continue;
        for (const double level : p.constant->levels) values.push_back(p.share(level));
    }
    for (LevelName& level : out) level.values.push_back(level.standard);
    return out;
}

std::vector<AskSpec> questions_of(const Task& task) {
    std::vector<AskSpec> out;
    for (const State& state : task.states) {
        for (const AskSpec& ask : state.questions()) {
            const auto same = [&](const AskSpec& other) { return other.name == ask.name; };
            if (std::none_of(out.begin(), out.end(), same)) out.push_back(ask);
        }
    }
    return out;
}

std::vector<std::string> forms_of(const Task& task) {
    std::vector<std::string> out;
    bool any = false;
    for (const State& state : task.states) {
        std::string& form = out.emplace_back();
        if (!state.form) continue;
        any = true;
        form = state.form->title;
        if (!state.form->version.empty()) form += ", version " + state.form->version;
    }
    if (!any) out.clear();
    return out;
}

}  // namespace dihaptic::task
