#include "task/task_plan.h"

#include <cctype>
#include <cmath>
#include <set>

#include "task/clearance.h"
#include "task/lookup.h"
#include "task/reach_plan.h"

namespace dihaptic::task {
namespace {

constexpr size_t kMostStates = 64;
constexpr size_t kMostTrials = 100000;
constexpr const char* kMoveAway = "Take the hands off the objects";
constexpr const char* kSkipped = "skipped";

/// Index of a text in a list, to which it is added when new; -1 for an empty text.
int listed(std::vector<std::string>& list, const std::string& text) {
    if (text.empty()) return -1;
    const auto found = std::find(list.begin(), list.end(), text);
    if (found != list.end()) return static_cast<int>(found - list.begin());
    list.push_back(text);
    return static_cast<int>(list.size()) - 1;
}

/// The list, with each item replaced by the one of the same name in `others`, if there is one.
template <class T>
std::vector<T> replaced(std::vector<T> list, const std::vector<T>& others) {
    for (T& item : list) {
        for (const T& other : others) {
            if (other.name == item.name) item = other;
        }
    }
    return list;
}

bool is_key(const std::string& text) {
    return text.size() == 1 && std::isalnum(static_cast<unsigned char>(text[0])) != 0;
}

class Planner {
  public:
    Planner(const Task& task, const scene::Scene& scene, Diagnostics& diagnostics)
        : scene_(scene),
          diagnostics_(diagnostics),
          regions_(names_of(task.regions)),
          bodies_(names_of(scene.bodies)),
          fingers_(scene::finger_names(scene)) {
        plan_.task = task;
    }

    TaskPlan plan() {
        check_lists();
        plan_.move_away = listed(plan_.messages, kMoveAway);
        for (const State& state : plan_.task.states) plan_.stages.push_back(stage(state));
        plan_.skipped = static_cast<int>(plan_.outcomes.size());
        plan_.outcomes.push_back({kSkipped, false});
        check_ways();
        make_cells();
        for (const ProcedureSpec& procedure : plan_.task.procedures) check_procedure(procedure);
        for (const Block& block : plan_.task.blocks) check_block(block);
        check_reach();
        for (const scene::Finger& finger : scene_.fingers)
            plan_.finger_radius.push_back(reach_of(finger));
        return std::move(plan_);
    }

  private:
    void error(const Place& place, const std::string& key, const std::string& what,
               const std::string& remedy) {
        diagnostics_.error(place, key, what, remedy);
    }

    void check_lists() {
        const Task& task = plan_.task;
        check_names(task.regions, "regions", diagnostics_);
        check_names(task.perturbations, "perturbations", diagnostics_);
        check_names(task.states, "states", diagnostics_);
        check_names(task.conditions, "conditions", diagnostics_);
        check_names(task.rounds, "rounds", diagnostics_);
        check_names(task.procedures, "procedures", diagnostics_);
        check_names(task.blocks, "blocks", diagnostics_);
        if (task.regions.size() > servo::TaskFrame::kMostTargets) {
            error(task.place, "regions",
                  fmt::format("there are {}, where {} are the most", task.regions.size(),
                              servo::TaskFrame::kMostTargets),
                  "Let conditions move one region about.");
        }
        if (task.states.empty()) error(task.place, "states", "there are none", "Add one at least.");
        if (task.states.size() > kMostStates)
            error(task.place, "states", fmt::format("there are more than {}", kMostStates), "");
        if (task.blocks.empty())
            error(task.place, "blocks", "there are none", "Add one at least, with its trials.");
        for (const auto* list : {&task.conditions, &task.rounds}) {
            for (const Condition& condition : *list) check_condition(condition);
        }
    }

    void check_condition(const Condition& condition) {
        for (const BodyPlace& place : condition.places) {
            const int body =
                look_up(bodies_, place.body, place.place, "body", "no body", diagnostics_);
            if (body >= 0 && !scene_.bodies[static_cast<size_t>(body)].moves_at_all())
                error(place.place, "body", fmt::format("'{}' cannot move", place.body),
                      "Name a body that can.");
        }
        for (const Region& region : condition.regions)
            look_up(regions_, region.name, region.place, "name", "no region of the task",
                    diagnostics_);
        for (const PerturbationSpec& spec : condition.perturbations)
            look_up(names_of(plan_.task.perturbations), spec.name, spec.place, "name",
                    "no perturbation of the task", diagnostics_);
    }

    int region(const std::string& name, const Place& place, const char* key) {
        return look_up(regions_, name, place, key, "no region", diagnostics_);
    }

    TaskPlan::Stage stage(const State& state) {
        TaskPlan::Stage out;
        for (const std::string& name : state.show) {
            if (const int i = region(name, state.place, "show"); i >= 0) out.shown |= 1u << i;
        }
        out.perturbed = state.perturbed;
        out.message = listed(plan_.messages, state.message);
        out.marker = state.marker;
        for (const Exit& exit : state.exits) out.ways.push_back(way(exit));
        for (const HandStep& step : state.hand) {
            const int reach = step.reach.empty() ? -1 : region(step.reach, step.place, "reach");
            out.hand.push_back({step, reach});
        }
        if (state.exits.empty()) {
            error(state.place, state.name, "never ends",
                  "Add exits, e.g. - { when: time, hold_s: 5, outcome: too late, redo: yes }.");
        }
        return out;
    }

    TaskPlan::Way way(const Exit& exit) {
        TaskPlan::Way out;
        out.exit = exit;
        out.finger = judged_finger(exit);
        look_up_condition(exit, out);
        if (exit.to.empty() == exit.outcome.empty()) {
            error(exit.place, "to",
                  exit.to.empty() ? "leads nowhere" : "leads to a state and out of the trial",
                  "Give it either to: a state, or outcome: what became of the trial.");
        }
        if (!exit.to.empty()) {
            out.state = look_up(names_of(plan_.task.states), exit.to, exit.place, "to", "no state",
                                diagnostics_);
        }
        if (!exit.outcome.empty()) out.outcome = outcome(exit);
        out.feedback = listed(plan_.messages, exit.feedback);
        return out;
    }

    int judged_finger(const Exit& exit) {
        if (!exit.finger.empty())
            return look_up(fingers_, exit.finger, exit.place, "finger",
                           "none of the scene's fingers", diagnostics_);
        return exit.has(WhenRow::any_finger) ? -1 : 0;
    }

    /// Looks up the names in the exit's condition.
    void look_up_condition(const Exit& exit, TaskPlan::Way& out) {
        if (exit.has(WhenRow::region)) out.region = region(exit.region, exit.place, "region");
        if (exit.has(WhenRow::body)) {
            out.body = look_up(bodies_, exit.body, exit.place, "body", "no body", diagnostics_);
            check_body(exit, out.body);
        }
        if (exit.has(WhenRow::key) && !is_key(exit.key)) {
            error(exit.place, "key", fmt::format("'{}' is no key", exit.key),
                  "Write one letter or digit, e.g. key: y.");
        }
        if (exit.when == When::time && exit.hold <= 0)
            error(exit.place, "hold", "how long is missing", "Add e.g. hold_s: 2.");
        if (exit.when == When::trigger && exit.hold > 0)
            error(exit.place, "hold", "a trigger is over at once", "Leave it out.");
    }

    void check_body(const Exit& exit, int body) {
        if (body < 0) return;
        if (exit.when == When::lifted && !scene_.bodies[static_cast<size_t>(body)].moves_at_all())
            error(exit.place, "body", fmt::format("'{}' cannot move", exit.body),
                  "Name a body that can.");
        if (exit.when == When::gripped && fingers_.size() < 2)
            error(exit.place, "when", "a grip takes two fingers, and the scene has one",
                  "Use when: touched.");
    }

    int outcome(const Exit& exit) {
        if (exit.outcome == kSkipped)
            error(exit.place, "outcome",
                  fmt::format("'{}' is what a trial is that the operator skipped", kSkipped),
                  "Call it something else.");
        for (size_t i = 0; i < plan_.outcomes.size(); ++i) {
            if (plan_.outcomes[i].name != exit.outcome) continue;
            if (plan_.outcomes[i].redo != exit.redo) {
                error(exit.place, "redo",
                      fmt::format("'{}' is done again after one exit, and not after another",
                                  exit.outcome),
                      "Give the two outcomes different names.");
            }
            return static_cast<int>(i);
        }
        plan_.outcomes.push_back({exit.outcome, exit.redo});
        return static_cast<int>(plan_.outcomes.size()) - 1;
    }

    /// Every state must be reachable from the first one, and must lead out of the trial.
    void check_ways() {
        const size_t n = plan_.stages.size();
        std::vector<char> reached(n, 0);
        std::vector<char> leaves(n, 0);
        if (n > 0) reached[0] = 1;
        for (size_t round = 0; round < n; ++round) {
            for (size_t i = 0; i < n; ++i) {
                for (const TaskPlan::Way& way : plan_.stages[i].ways) {
                    if (way.outcome >= 0) leaves[i] = 1;
                    if (way.state < 0) continue;
                    const auto to = static_cast<size_t>(way.state);
                    if (reached[i]) reached[to] = 1;
                    if (leaves[to]) leaves[i] = 1;
                }
            }
        }
        for (size_t i = 0; i < n; ++i) {
            const State& state = plan_.task.states[i];
            if (!reached[i]) {
                diagnostics_.warning(state.place, state.name, "no exit leads to this state",
                                     "Remove it, or lead an exit to it.");
            } else if (!leaves[i] && !state.exits.empty()) {
                error(state.place, state.name, "no way leads from here to an outcome",
                      "Give one of its exits an outcome.");
            }
        }
    }

    void make_cells() {
        const Condition nothing;
        const auto or_one = [&](const std::vector<Condition>& list) {
            return list.empty() ? std::vector<Condition>{nothing} : list;
        };
        std::set<std::string> said;  // a mistake shows in every cell, and is reported once
        for (const Condition& round : or_one(plan_.task.rounds)) {
            for (const Condition& condition : or_one(plan_.task.conditions)) {
                TaskPlan::Cell& cell = plan_.cells.emplace_back();
                const auto regions =
                    replaced(replaced(plan_.task.regions, round.regions), condition.regions);
                for (const Region& region : regions) {
                    cell.p_W.push_back(region.position);
                    cell.radius.push_back(region.radius);
                }
                Diagnostics found;
                for (const PerturbationSpec& spec :
                     replaced(replaced(plan_.task.perturbations, round.perturbations),
                              condition.perturbations)) {
                    cell.perturbations.emplace_back(spec, regions, scene_, found);
                }
                cell.homes = homes({&round, &condition});
                for (const Problem& problem : found.problems()) {
                    if (said.insert(problem.text()).second) diagnostics_.add({problem});
                }
            }
        }
    }

    void check_procedure(const ProcedureSpec& procedure) {
        check(procedure, diagnostics_);
        look_up(names_of(plan_.task.perturbations), procedure.perturb, procedure.place, "perturb",
                "no perturbation", diagnostics_);
        for (const auto& [key, name] : {std::pair{"yes", &procedure.yes}, {"no", &procedure.no}}) {
            const int i = look_up(names_of(plan_.outcomes), *name, procedure.place, key,
                                  "no outcome", diagnostics_);
            if (i >= 0 && plan_.outcomes[static_cast<size_t>(i)].redo)
                error(procedure.place, key, fmt::format("'{}' is done again", *name),
                      "Leave out redo where an answer ends the trial.");
        }
    }

    void check_block(const Block& block) {
        for (const std::string& name : block.conditions)
            look_up(names_of(plan_.task.conditions), name, block.place, "conditions",
                    "no condition", diagnostics_);
        check_perturbation(block.perturb, block.place);
        const size_t answers = most_answers(block);
        check_ways_to_perturb(block);
        const size_t conditions = block.conditions.empty()
                                      ? std::max<size_t>(1, plan_.task.conditions.size())
                                      : block.conditions.size();
        if (block.order == Order::counterbalanced && conditions > 8)
            error(block.place, "order", "more than 8 conditions have too many orders",
                  "Use latin_square.");
        const size_t trials =
            block.procedures.empty() ? conditions * static_cast<size_t>(block.repeats) : answers;
        for (const Insert& insert : block.insert) {
            check_perturbation(insert.perturb, insert.place);
            if (static_cast<size_t>(insert.count) > trials)
                error(insert.place, "count",
                      fmt::format("is {}, more than the block's {} trials", insert.count, trials),
                      "Insert fewer, or raise the block's repeats.");
        }
        trials_ += trials * std::max<size_t>(1, plan_.task.rounds.size());
        if (trials_ > kMostTrials)
            error(block.place, "repeats",
                  fmt::format("makes more than {} trials in all", kMostTrials), "Lower it.");
    }

    void check_perturbation(const std::string& name, const Place& place) {
        if (!name.empty())
            look_up(names_of(plan_.task.perturbations), name, place, "perturb", "no perturbation",
                    diagnostics_);
    }

    /// Largest number of trials that the block's procedures may ask for in all.
    size_t most_answers(const Block& block) {
        size_t out = 0;
        for (const std::string& name : block.procedures) {
            const int i = look_up(names_of(plan_.task.procedures), name, block.place, "procedures",
                                  "no procedure", diagnostics_);
            if (i >= 0)
                out += static_cast<size_t>(plan_.task.procedures[static_cast<size_t>(i)].trials);
        }
        return out;
    }

    /// A block has either a perturbation, ramped or not, or procedures that choose one, or neither.
    void check_ways_to_perturb(const Block& block) {
        if (!block.procedures.empty() && (!block.perturb.empty() || block.ramp > 0))
            error(block.place, "procedures", "choose the perturbation and its share by themselves",
                  "Leave out perturb and ramp.");
        if (block.kind == TrialKind::perturbed && block.perturb.empty() && block.procedures.empty())
            error(block.place, "perturb", "is missing in a perturbed block",
                  "Name a perturbation, or make it a baseline block.");
        if (block.kind == TrialKind::error_clamp && block.perturb.empty())
            error(block.place, "perturb", "is missing in a block of error clamps",
                  "Name a perturbation with a line (toward), or a channel.");
        if (block.ramp > 0 && block.perturb.empty())
            error(block.place, "ramp", "there is nothing to ramp", "Add perturb.");
    }

    void check_reach() {
        if (!plan_.task.reach) return;
        const ReachMeasure& reach = *plan_.task.reach;
        region(reach.from, reach.place, "from");
        region(reach.to, reach.place, "to");
        look_up(names_of(plan_.task.states), reach.during, reach.place, "during", "no state",
                diagnostics_);
        if (!reach.finger.empty())
            look_up(fingers_, reach.finger, reach.place, "finger", "none of the scene's fingers",
                    diagnostics_);
        if (reach.axis && reach.axis->norm() <= 0)
            error(reach.place, "axis", "has no direction", "Write e.g. axis: [0, 0, 1].");
    }

    /// Where bodies begin a trial; places of later conditions replace those of earlier ones.
    std::vector<TaskPlan::Home> homes(std::initializer_list<const Condition*> conditions) const {
        std::vector<TaskPlan::Home> out;
        for (size_t i = 0; i < scene_.bodies.size(); ++i) {
            const scene::Body& body = scene_.bodies[i];
            if (!body.moves_at_all()) continue;
            Pose X_WB = body.pose();
            for (const Condition* condition : conditions) {
                for (const BodyPlace& place : condition->places) {
                    if (place.body == body.name) X_WB.p = place.position;
                }
            }
            out.push_back({static_cast<int>(i), X_WB, scene::bounds(body.shape)});
        }
        return out;
    }

    const scene::Scene& scene_;
    Diagnostics& diagnostics_;
    std::vector<std::string> regions_;
    std::vector<std::string> bodies_;
    std::vector<std::string> fingers_;
    size_t trials_ = 0;
    TaskPlan plan_;
};

}  // namespace

std::vector<std::string> TaskPlan::phases() const {
    std::vector<std::string> out{"between trials"};
    for (const State& state : task.states) out.push_back(state.name);
    return out;
}

TaskPlan plan_task(const Task& task, const scene::Scene& scene, Diagnostics& diagnostics) {
    return Planner(task, scene, diagnostics).plan();
}

Table frozen_list(const TaskPlan& plan, const scene::Scene& scene) {
    Table table = trial_list(plan.task, plan.trials);
    if (plan.task.reach) add_reaches(table, plan, scene);
    return table;
}

Table procedure_table(const TaskPlan& plan) {
    Table table;
    table.columns = {{"procedure", "name"},
                     {"kind", "staircase, quest or quest_plus"},
                     {"perturbation", "whose share it chooses"},
                     {"logarithmic", "the share is 10^level"},
                     {"yes", "outcome that grows likelier with the level"},
                     {"no", "the other"},
                     {"sigmoid", "of the psychometric function"},
                     {"guess", "its lower end"},
                     {"guess_is_lapse", "or the lapse rate is"}};
    const auto yes_no = [](bool yes) { return std::string(yes ? "yes" : "no"); };
    for (const ProcedureSpec& p : plan.task.procedures) {
        table.rows.push_back({p.name, std::string(p.kind()), p.perturb, yes_no(p.logarithmic),
                              p.yes, p.no, std::string(enum_name(p.sigmoid)), p.guess,
                              yes_no(p.guess_is_lapse)});
    }
    return table;
}

}  // namespace dihaptic::task
