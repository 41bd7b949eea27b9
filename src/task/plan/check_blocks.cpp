#include "task/plan/check_blocks.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "task/plan/levels.h"
#include "task/plan/lookup.h"

namespace dihaptic::task {
namespace {

constexpr size_t kMostTrials = 100000;
constexpr size_t kMostPerturbations = 8;  // maximum number of perturbations in a trial

class BlockChecker {
  public:
    BlockChecker(const TaskPlan& plan, Diagnostics& diagnostics)
        : plan_(plan), task_(plan.task), diagnostics_(diagnostics) {}

    void check() {
        for (const ProcedureSpec& procedure : task_.procedures) check_procedure(procedure);
        for (const Block& block : task_.blocks) check_block(block);
        if (!diagnostics_.has_errors()) check_levels_named();
    }

  private:
    void error(const Place& place, const std::string& key, const std::string& what,
               const std::string& remedy) {
        diagnostics_.error(place, key, what, remedy);
    }

    void check_procedure(const ProcedureSpec& procedure) {
        task::check(procedure, diagnostics_);
        check_perturbations(procedure.perturb, procedure.place);
        for (const auto& [key, name] : {std::pair{"yes", &procedure.yes}, {"no", &procedure.no}}) {
            if (name->empty()) continue;
            const int i = look_up(names_of(plan_.outcomes), *name, procedure.place, key,
                                  "not an outcome", diagnostics_);
            if (i >= 0 && plan_.outcomes[static_cast<size_t>(i)].redo)
                error(procedure.place, key,
                      fmt::format("trials that end with '{}' are repeated", *name),
                      "Leave out 'redo' where an answer ends the trial.");
        }
    }

    void check_block(const Block& block) {
        check_perturbations(block.perturb, block.place);
        const size_t answers = most_answers(block);
        check_ways_to_perturb(block);
        const size_t conditions = block.conditions.empty()
                                      ? std::max<size_t>(1, task_.conditions.size())
                                      : block.conditions.size();
        if (block.order == Order::counterbalanced && conditions > 8)
            error(block.place, "order", "more than 8 conditions have too many possible orders",
                  "Use latin_square.");
        const size_t trials =
            block.procedures.empty() ? conditions * static_cast<size_t>(block.repeats) : answers;
        for (const Insert& insert : block.insert) {
            check_perturbations(insert.perturb, insert.place);
            check_clamp(insert.kind, insert.perturb, insert.place);
            if (static_cast<size_t>(insert.count) > trials)
                error(insert.place, "count",
                      fmt::format("is {}, but the block has only {} trials", insert.count, trials),
                      "Insert fewer, or increase the block's repeats.");
            else if ((insert.count - 1.0) * insert.gap + 1 > static_cast<double>(trials))
                error(insert.place, "gap",
                      fmt::format("of {} between {} trials needs more than the block's {} trials",
                                  insert.gap, insert.count, trials),
                      "Insert fewer, reduce 'gap', or increase the block's repeats.");
        }
        trials_ += trials * (block.once == Once::no ? std::max<size_t>(1, task_.rounds.size()) : 1);
        if (trials_ > kMostTrials)
            error(block.place, "repeats",
                  fmt::format("makes more than {} trials in total", kMostTrials),
                  "Reduce 'repeats'.");
    }

    /// Checks the perturbations of a trial, individually and in combination.
    void check_perturbations(const Refs<PerturbationSpec>& names, const Place& place) {
        const std::vector<int>& which = names.indices;
        for (auto i = which.begin(); i != which.end(); ++i) {
            if (std::find(which.begin(), i, *i) != i)
                error(place, "perturb",
                      fmt::format("'{}' is named twice",
                                  task_.perturbations[static_cast<size_t>(*i)].name),
                      "Name it once, and make it stronger if needed.");
        }
        for (const PerturbationSpec& spec : task_.perturbations) {
            if (names.size() > 1 && spec.name.find(kBetweenNames) != std::string::npos)
                error(spec.place, "name",
                      fmt::format("'{}' would be read as several perturbations, which "
                                  "trial-list.csv joins with '{}'",
                                  spec.name, kBetweenNames),
                      "Give the perturbation another name.");
        }
        if (names.size() > kMostPerturbations) {
            error(place, "perturb",
                  fmt::format("names {} perturbations, but at most {} are allowed", names.size(),
                              kMostPerturbations),
                  "Combine several into one: a perturbation can have a visual map, a body and "
                  "loads.");
        }
        check_together(which, place);
    }

    /// Checks that no state has more than one visual map, or more loads than can act in a tick.
    /// Reports the first state that does.
    void check_together(const std::vector<int>& which, const Place& place) {
        for (const TaskPlan::Cell& cell : plan_.cells) {
            for (size_t s = 0; s < std::min(task_.states.size(), TaskPlan::kMostStates); ++s) {
                if (!fit_together(cell, which, static_cast<int>(s), place)) return;
            }
        }
    }

    bool fit_together(const TaskPlan::Cell& cell, const std::vector<int>& which, int state,
                      const Place& place) {
        const std::string& where = task_.states[static_cast<size_t>(state)].name;
        const std::string* map = nullptr;  // name of the perturbation with the visual map
        size_t loads = 0;
        for (const int i : which) {
            if (!cell.acts(i, state)) continue;
            const Perturbation& perturbation = cell.perturbations[static_cast<size_t>(i)];
            const std::string& name = task_.perturbations[static_cast<size_t>(i)].name;
            for (const Load& load : perturbation.loads()) loads += load.on().size();
            if (!perturbation.has_map()) continue;
            if (map != nullptr) {
                error(place, "perturb",
                      fmt::format("'{}' and '{}' both change the display in state '{}'", *map, name,
                                  where),
                      "Give them different states with 'during', or combine them into one "
                      "perturbation.");
                return false;
            }
            map = &name;
        }
        if (loads <= frame::TaskFrame::kMostLoads) return true;
        error(place, "perturb",
              fmt::format("makes {} loads act in state '{}', but at most {} are allowed", loads,
                          where, frame::TaskFrame::kMostLoads),
              "Leave some out, or combine loads on one thing into a load of kind 'general'.");
        return false;
    }

    /// Largest total number of trials that the procedures of the block can request.
    size_t most_answers(const Block& block) {
        size_t out = 0;
        for (const int i : block.procedures.indices)
            out += static_cast<size_t>(task_.procedures[static_cast<size_t>(i)].trials);
        return out;
    }

    /// Checks that a block has a perturbation, with or without a ramp, or procedures that choose
    /// one, but not both. A block may also have neither.
    void check_ways_to_perturb(const Block& block) {
        if (!block.procedures.empty() && (!block.perturb.empty() || block.ramp > 0))
            error(block.place, "procedures", "already choose the perturbation and its share",
                  "Leave out 'perturb' and 'ramp'.");
        if (block.kind == TrialKind::perturbed && block.perturb.empty() && block.procedures.empty())
            error(block.place, "perturb", "is missing in a perturbed block",
                  "Name a perturbation, or write kind: baseline.");
        check_clamp(block.kind, block.perturb, block.place);
        if (block.ramp > 0 && block.perturb.empty())
            error(block.place, "ramp", "needs a perturbation", "Add 'perturb'.");
    }

    /// Checks that the kind of each trial, which determines its analysis, is consistent with its
    /// perturbation.
    void check_clamp(TrialKind kind, const std::vector<std::string>& perturb, const Place& place) {
        const bool channels = kind == TrialKind::force_channel;
        if (!channels && kind != TrialKind::visual_clamp) return;
        const char* const remedy = channels ? "Name a perturbation whose field is a channel."
                                            : "Name a perturbation with a line (visual: toward).";
        if (perturb.empty()) {
            error(place, "perturb", fmt::format("is missing in a {}", enum_name(kind)), remedy);
            return;
        }
        const std::vector<PerturbationSpec>& all = task_.perturbations;
        const bool has_channel = std::any_of(all.begin(), all.end(), [&](const auto& spec) {
            return is_channel(spec) &&
                   std::find(perturb.begin(), perturb.end(), spec.name) != perturb.end();
        });
        if (has_channel == channels) return;
        error(place, "kind",
              fmt::format("is {}, but '{}' {} a force channel", enum_name(kind),
                          fmt::join(perturb, kBetweenNames), channels ? "is not" : "is"),
              channels ? remedy : "Write kind: force_channel.");
    }

    /// Checks that each number chosen by a procedure has an effect.
    void check_levels_named() {
        for (size_t i = 0; i < task_.procedures.size(); ++i) {
            if (plan_.level_of_procedure[i] < 0) continue;
            const auto level = static_cast<size_t>(plan_.level_of_procedure[i]);
            const int slot = plan_.symbols.variables[plan_.levels[level].variable].slot;
            if (is_named(slot)) continue;
            const ProcedureSpec& procedure = task_.procedures[i];
            error(procedure.place, "level",
                  fmt::format("no formula uses {}", split_unit(procedure.level).name),
                  "Use it in a formula, e.g. friction_scale: friction / 0.5.");
        }
    }

    bool is_named(int slot) const {
        const auto in_transition = [&](const TaskPlan::Transition& transition) {
            return transition.condition.names(slot);
        };
        return std::any_of(plan_.formulas.begin(), plan_.formulas.end(),
                           [&](const CompiledFormula& f) { return f.expression.names(slot); }) ||
               std::any_of(plan_.states.begin(), plan_.states.end(),
                           [&](const TaskPlan::PlannedState& planned) {
                               return std::any_of(planned.transitions.begin(),
                                                  planned.transitions.end(), in_transition);
                           });
    }

    const TaskPlan& plan_;
    const Task& task_;
    Diagnostics& diagnostics_;
    size_t trials_ = 0;
};

}  // namespace

void check_blocks(const TaskPlan& plan, Diagnostics& diagnostics) {
    BlockChecker(plan, diagnostics).check();
}

}  // namespace dihaptic::task
