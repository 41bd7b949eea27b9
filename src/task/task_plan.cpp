#include "task/task_plan.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <bit>
#include <cmath>
#include <set>

#include "base/unmeasured.h"
#include "rows/procedure_row.h"
#include "task/check_blocks.h"
#include "task/clearance.h"
#include "task/factors.h"
#include "task/levels.h"
#include "task/lookup.h"
#include "task/own_measures.h"
#include "task/plan_formulas.h"
#include "task/reach_plan.h"
#include "task/seen_plan.h"

namespace dihaptic::task {
namespace {

/// Where bodies are that a state removes: beyond any plane, and far from each other [m].
constexpr double kAway = 1000;
constexpr double kApart = 100;
constexpr const char* kMoveAway = "Take the hands off the objects";
constexpr const char* kSkipped = "skipped";

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

/// A name as an expression has it.
std::string quoted(const std::string& name) {
    std::string out = "\"";
    for (const char c : name) {
        if (c == '"' || c == '\\') out += '\\';
        out += c;
    }
    return out + '"';
}

/// A number of a condition as an expression has it.
std::string as_expression(const Formula& number, const TaskPlan& plan, const char* unit) {
    if (number.index < 0) return fmt::format("{}", number.value);
    const CompiledFormula& compiled = plan.formulas[static_cast<size_t>(number.index)];
    if (compiled.expression.dimension() != Dimension{}) return fmt::format("({})", number.text);
    return fmt::format("({}) * {} {}", number.text, number.to_si, unit);
}

/// What a condition of the table says, as an expression; "" for what no expression can say.
std::string as_expression(const Exit& exit, const TaskPlan& plan) {
    const std::string who = quoted(exit.what.empty() ? exit.finger : exit.what);
    const std::string body = quoted(exit.body);
    switch (exit.when) {
        case When::inside:
        case When::outside:
            return fmt::format("{}({}{}, {})", enum_name(exit.when), who,
                               exit.shown ? ".shown" : "", quoted(exit.region));
        case When::touched:
        case When::released:
        case When::gripped:
            return fmt::format("{}({}, {})", enum_name(exit.when), body, who);
        case When::lifted:
            return fmt::format("lifted({}, {})", body, as_expression(exit.height, plan, "m"));
        case When::still:
            return fmt::format("still({}, {})", who, as_expression(exit.speed, plan, "m_s"));
        case When::expression:
            return exit.condition;
        default:
            return "";
    }
}

class Planner {
  public:
    Planner(const Task& task, const scene::Scene& scene, Diagnostics& diagnostics)
        : scene_(scene),
          diagnostics_(diagnostics),
          regions_(names_of(task.regions)),
          bodies_(names_of(scene.bodies)),
          fingers_(scene::finger_names(scene)),
          plan_(plan_of(task)),
          seen_(plan_, scene, diagnostics) {
        plan_.quantities = Quantities({.fingers = fingers_,
                                       .bodies = bodies_,
                                       .joints = names_of(recorded_joints(scene)),
                                       .regions = regions_,
                                       .hands = hands()});
        // what no trial places stays there
        for (size_t i = 0; i < bodies_.size(); ++i)
            plan_.quantities.set(plan_.quantities.start(i), scene.bodies[i].pose().p);
        plan_.bodies = scene.bodies.size();
    }

    TaskPlan plan() {
        cross_factors(plan_.task, diagnostics_);
        complete_intervals(plan_.task, diagnostics_);
        check_lists();
        plan_intervals();
        plan_formulas(plan_, diagnostics_);
        plan_.move_away = seen_.text(kMoveAway, plan_.task.place, "message");
        plan_sounds();
        for (const State& state : plan_.task.states) plan_.stages.push_back(stage(state));
        plan_.skipped = static_cast<int>(plan_.outcomes.size());
        plan_.outcomes.push_back({kSkipped, false});
        check_ways();
        make_cells();
        seen_.plan_task();
        check_blocks(plan_, diagnostics_);
        check_reach();
        plan_rules(plan_, diagnostics_);
        check_measures(plan_, scene_, diagnostics_);
        plan_own_measures(plan_, diagnostics_);
        for (const scene::Finger& finger : scene_.fingers)
            plan_.finger_radius.push_back(reach_of(finger));
        return std::move(plan_);
    }

  private:
    static TaskPlan plan_of(const Task& task) {
        TaskPlan out;
        out.task = task;
        return out;
    }
    void error(const Place& place, const std::string& key, const std::string& what,
               const std::string& remedy, std::vector<Choice> choices = {}) {
        diagnostics_.error(place, key, what, remedy, std::move(choices));
    }

    void check_lists() {
        const Task& task = plan_.task;
        check_names(task.hands, "hands", diagnostics_);
        check_names(task.regions, "regions", diagnostics_);
        check_names(task.perturbations, "perturbations", diagnostics_);
        check_names(task.sounds, "sounds", diagnostics_);
        check_names(task.states, "states", diagnostics_);
        check_names(task.conditions, "conditions", diagnostics_);
        check_names(task.draws, "draws", diagnostics_);
        check_names(task.variables, "variables", diagnostics_);
        check_names(task.rounds, "rounds", diagnostics_);
        check_names(task.procedures, "procedures", diagnostics_);
        check_names(task.blocks, "blocks", diagnostics_);
        if (task.regions.size() > frame::TaskFrame::kMostTargets) {
            error(task.place, "regions",
                  fmt::format("there are {}, where {} are the most", task.regions.size(),
                              frame::TaskFrame::kMostTargets),
                  "Let conditions move one region about.");
        }
        if (task.sounds.size() > TaskPlan::kMostSounds)
            error(task.sounds.back().place, "sounds",
                  fmt::format("there are {}, where {} are the most", task.sounds.size(),
                              TaskPlan::kMostSounds),
                  "Leave out those that no state needs.");
        if (task.states.empty()) error(task.place, "states", "there are none", "Add one at least.");
        if (task.states.size() > TaskPlan::kMostStates)
            error(task.place, "states",
                  fmt::format("there are more than {}", TaskPlan::kMostStates), "");
        if (task.blocks.empty())
            error(task.place, "blocks", "there are none", "Add one at least, with its trials.");
        for (const auto* list : {&task.conditions, &task.rounds}) {
            for (const Condition& condition : *list) check_condition(condition);
        }
    }

    void plan_sounds() {
        const std::vector<SoundSpec>& sounds = plan_.task.sounds;
        for (size_t i = 0; i < sounds.size() && i < TaskPlan::kMostSounds; ++i) {
            check(sounds[i], diagnostics_);
            if (sounds[i].lasts == Lasts::state) plan_.going_on |= 1u << i;
            if (sounds[i].lasts == Lasts::session) plan_.throughout |= 1u << i;
        }
    }

    /// The sounds of these names, which `where` begins.
    uint32_t sounds(const std::vector<std::string>& names, const Place& where, const char* key) {
        uint32_t out = 0;
        for (const std::string& name : names) {
            const int i = look_up(names_of(plan_.task.sounds), name, where, key,
                                  "no sound of the task", diagnostics_);
            if (i < 0 || i >= TaskPlan::kMostSounds) continue;
            out |= 1u << i;
            if ((plan_.throughout >> i & 1u) != 0)
                error(where, key, fmt::format("'{}' lasts throughout the session", name),
                      "Leave it out here, or let it last once or as long as a state.");
        }
        return out;
    }

    /// The sound that an exit begins.
    uint32_t sound(const Exit& exit) {
        if (exit.sound.empty()) return 0;
        const uint32_t out = sounds({exit.sound}, exit.place, "sound");
        if ((out & plan_.going_on) != 0)
            error(
                exit.place, "sound",
                fmt::format("'{}' lasts as long as a state, and an exit has no length", exit.sound),
                "Name it in the state that follows, or let it last once.");
        return out;
    }

    void plan_intervals() {
        if (!has_intervals(plan_.task)) return;
        plan_.comparison = look_up(names_of(plan_.task.draws), kComparisonInterval,
                                   plan_.task.place, "draws", "no draw", diagnostics_);
    }

    int body(const std::string& name, const Place& place, const char* key) {
        return look_up(bodies_, name, place, key, "no body", diagnostics_);
    }

    /// A body that something is to move.
    int movable(const std::string& name, const Place& place, const char* key) {
        const int index = body(name, place, key);
        if (index >= 0 && !scene_.bodies[static_cast<size_t>(index)].moves_at_all())
            error(place, key, fmt::format("'{}' cannot move", name), "Name a body that can.");
        return index;
    }

    /// A body that can be put somewhere.
    int placeable(const std::string& name, const Place& place) {
        const int index = body(name, place, "body");
        if (index >= 0 &&
            scene_.bodies[static_cast<size_t>(index)].shape.kind == scene::ShapeKind::plane)
            error(place, "body", fmt::format("'{}' is a plane, which has no other place", name),
                  "Name another body, e.g. a box.");
        return index;
    }

    void check_condition(const Condition& condition) {
        if (!condition.object.empty()) movable(condition.object, condition.place, "object");
        for (const BodyPlace& place : condition.places) {
            check_joint(place, scene_, diagnostics_);
            if (place.joint.empty() && !place.body.empty()) placeable(place.body, place.place);
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
        out.message = seen_.text(state.message, state.place, "message");
        seen_.plan_state(state, out);
        out.marker = state.marker;
        out.sounds = sounds(state.sounds, state.place, "sounds");
        out.interval = state.interval;
        if (state.ask) out.question = question(*state.ask);
        check_answered(state);
        for (const StatePlace& place : state.places) add_put(place, out.puts);
        for (const DriveSpec& drive : state.drives) add_drive(drive, out);
        for (const MotorSpec& motor : state.motors) add_motor(motor, out);
        for (const Exit& exit : state.exits) out.ways.push_back(way(exit));
        for (const HandStep& step : state.hand) {
            const int reach = step.reach.empty() ? -1 : region(step.reach, step.place, "reach");
            out.hand.push_back({step, reach});
            if (!step.fingers.empty())
                out.hand.back().fingers = fingers_of(step.fingers, step.place);
        }
        if (state.exits.empty()) {
            error(state.place, state.name, "never ends",
                  "Add exits, e.g. - { when: time, after_s: 5, outcome: too late, redo: yes }.");
        }
        return out;
    }

    scene::FingerSet fingers_of(const std::vector<std::string>& fingers, const Place& place) {
        scene::FingerSet out;
        for (const std::string& finger : fingers) {
            const int i = look_up(fingers_, finger, place, "fingers", "none of the scene's fingers",
                                  diagnostics_);
            if (i >= 0) out.set(static_cast<size_t>(i));
        }
        return out;
    }

    Question question(const AskSpec& ask) {
        check(ask, diagnostics_);
        const std::vector<std::string> names = names_of(questions_of(plan_.task));
        const auto index = std::find(names.begin(), names.end(), ask.name) - names.begin();
        Question out;
        out.least = ask.least();
        out.most = ask.most();
        out.whole = ask.whole();
        out.by = ask.by;
        out.variable =
            plan_.task.variables.size() + plan_.levels.size() + static_cast<size_t>(index);
        out.si = split_unit(ask.name).si;
        if (ask.by == AnswerBy::cursor && ask.between.size() == 2) {
            out.from = region(ask.between[0], ask.place, "between");
            out.to = region(ask.between[1], ask.place, "between");
        }
        return out;
    }

    void check_answered(const State& state) {
        for (const Exit& exit : state.exits) {
            if (exit.when != When::answered) continue;
            if (!state.ask) {
                error(exit.place, "when", "the state asks for no number",
                      "Add e.g. ask: { name: heaviness, scale: numbers, from: 1, to: 9 }.");
            } else if (state.ask->by == AnswerBy::cursor) {
                error(exit.place, "when", "a hand on a line has always an answer",
                      "Say when it counts, e.g. when: still, hold_s: 1.");
            }
            if (exit.hold != 0)
                error(exit.place, "hold", "an answer is given at once", "Leave it out.");
        }
    }

    std::vector<Quantities::Names::Hand> hands() {
        std::vector<Quantities::Names::Hand> out;
        for (const Hand& hand : plan_.task.hands) {
            out.push_back({hand.name, fingers_of(hand.fingers, hand.place)});
            const std::vector<std::string> joints = names_of(recorded_joints(scene_));
            const auto is = [&](const std::string& other) { return other == hand.name; };
            if (std::any_of(fingers_.begin(), fingers_.end(), is) ||
                std::any_of(bodies_.begin(), bodies_.end(), is) ||
                std::any_of(joints.begin(), joints.end(), is))
                error(hand.place, "name",
                      fmt::format("'{}' is a finger, a body or a joint of the scene", hand.name),
                      "Call the hand something else.");
            if (hand.fingers.empty())
                error(hand.place, "fingers", "there are none", "Name one at least.");
        }
        return out;
    }

    void check_put(const StatePlace& place, const scene::Body& body) {
        if (!place.position && !place.velocity && !place.held && !place.removed)
            error(place.place, "position", "what becomes of the body is missing",
                  "Add position_mm, velocity_mm_s, held: yes or removed: yes.");
        if (place.velocity && (place.held || place.removed || body.fixed || body.driven))
            error(place.place, "velocity", "is of a body that is free to move",
                  "Leave it out, or held and removed, or let the body move in the scene.");
        if (place.removed && (place.position || place.held))
            error(place.place, "removed", "a body that is removed is nowhere else",
                  "Leave out position_mm and held.");
        if (place.held && body.fixed)
            error(place.place, "held", fmt::format("'{}' is fixed: it stays anyway", place.body),
                  "Leave it out.");
    }

    void add_put(const StatePlace& place, std::vector<TaskPlan::Put>& puts) {
        const int index = placeable(place.body, place.place);
        if (index < 0) return;
        const scene::Body& body = scene_.bodies[static_cast<size_t>(index)];
        check_put(place, body);
        for (const TaskPlan::Put& put : puts) {
            if (put.home.body == index)
                error(place.place, "body", fmt::format("'{}' is put twice", place.body),
                      "Keep one of the two.");
        }
        const Vec3 away(kApart * index, 0, kAway);
        const FormulaVec3 position =
            place.removed ? as_formula(away) : place.position.value_or(as_formula(body.position));
        TaskPlan::Put& put = puts.emplace_back(TaskPlan::Put{
            home(index, position), place.position || place.removed, place.held || place.removed});
        if (place.velocity) put.home.velocity = *place.velocity;
    }

    void add_drive(const DriveSpec& spec, TaskPlan::Stage& out) {
        const int index = body(spec.body, spec.place, "body");
        if (index < 0) return;
        const scene::Body& driven = scene_.bodies[static_cast<size_t>(index)];
        if (!driven.driven && !driven.moves_at_all())
            error(spec.place, "body", fmt::format("'{}' is fixed in the scene", spec.body),
                  "Write driven: yes there, in place of fixed: yes.");
        const auto same = [&](const auto& other) {
            if constexpr (requires { other.home; })
                return other.home.body == index && other.stays;
            else
                return other.body() == index;
        };
        if (std::any_of(out.drives.begin(), out.drives.end(), same) ||
            std::any_of(out.puts.begin(), out.puts.end(), same))
            error(spec.place, "body", fmt::format("'{}' is driven or held twice", spec.body),
                  "Keep one of the two.");
        out.drives.emplace_back(spec, index, plan_.quantities, diagnostics_);
    }

    void add_motor(const MotorSpec& spec, TaskPlan::Stage& out) {
        const int index = look_up(names_of(recorded_joints(scene_)), spec.joint, spec.place,
                                  "joint", "no joint of the scene", diagnostics_);
        if (index < 0) return;
        const scene::Joint& joint = scene_.joints[static_cast<size_t>(index)];
        if (!joint.has_coordinate()) {
            error(spec.place, "joint",
                  fmt::format("'{}' has no axis that a motor could move: it is a {} joint",
                              joint.name, enum_name(joint.kind)),
                  "Name a hinge, a slider or a distance.");
            return;
        }
        if (std::any_of(out.motors.begin(), out.motors.end(),
                        [&](const Motor& other) { return other.joint() == index; }))
            error(spec.place, "joint", fmt::format("'{}' has two motors", joint.name),
                  "Keep one of the two: it may both go somewhere and push.");
        if (out.motors.size() == frame::TaskFrame::kMostMotors)
            error(spec.place, "joint",
                  fmt::format("there are more than {} motors", out.motors.size()),
                  "Leave out some.");
        out.motors.emplace_back(spec, joint, index, plan_.quantities, diagnostics_);
    }

    TaskPlan::Way way(const Exit& exit) {
        TaskPlan::Way out;
        out.exit = exit;
        if (exit.has(WhenRow::finger) && !exit.finger.empty())
            out.finger = look_up(fingers_, exit.finger, exit.place, "finger",
                                 "none of the scene's fingers", diagnostics_);
        out.condition = condition(exit);
        const int ways = !exit.to.empty() + !exit.outcome.empty() + (exit.chooses > 0);
        if (ways != 1) {
            error(exit.place, "to", ways == 0 ? "leads nowhere" : "leads to more than one place",
                  "Give it to: a state, or outcome: what became of the trial, or chooses: an "
                  "interval.");
        }
        if (exit.chooses > 0) out.outcome = choice(exit);
        if (!exit.to.empty()) {
            out.state = look_up(names_of(plan_.task.states), exit.to, exit.place, "to", "no state",
                                diagnostics_);
        }
        if (!exit.outcome.empty()) out.outcome = outcome(exit);
        out.feedback = seen_.text(exit.feedback, exit.place, "feedback");
        out.sounds = sound(exit);
        return out;
    }

    /// Any of the two outcomes: which it is follows from the trial.
    int choice(const Exit& exit) {
        if (plan_.comparison < 0)
            error(exit.place, "chooses", "there are no intervals to choose from",
                  "Add interval: 1 and interval: 2 to states, or give it an outcome.");
        Exit chosen = exit;
        chosen.outcome = kStandard;
        plan_.chose_standard = outcome(chosen);
        chosen.outcome = kComparison;
        return plan_.chose_comparison = outcome(chosen);
    }

    Expression condition(const Exit& exit) {
        const size_t before = diagnostics_.problems().size();
        check_condition(exit);
        if (exit.when == When::expression) check_word(exit);
        const std::string text = as_expression(exit, plan_);
        if (text.empty() || diagnostics_.problems().size() > before) return {};
        Expression out =
            Expression::compile(text, plan_.quantities, exit.place, "when", diagnostics_);
        if (!out.empty() && out.type() != Expression::Type::truth)
            error(exit.place, "when", fmt::format("'{}' is no condition", text),
                  fmt::format("Compare it with something, e.g. {} > 2.", text));
        return out;
    }

    /// A single word that is no quantity was meant as one of the table's.
    void check_word(const Exit& exit) {
        const std::string& text = exit.condition;
        if (!is_word(text) || plan_.quantities.find(text)) return;
        std::vector<std::string> words;
        for (size_t i = 0; i < static_cast<size_t>(When::expression); ++i)
            words.emplace_back(kWhenTable[i].name);
        const std::string guess = nearest(text, words);
        std::vector<Choice> choices = choices_of(words);
        for (const Choice& quantity : choices_of(plan_.quantities.names()))
            choices.push_back(quantity);
        error(exit.place, "when", fmt::format("'{}' is not known", text),
              guess.empty() ? fmt::format("Use {}, or an expression.", fmt::join(words, ", "))
                            : fmt::format("Did you mean {}?", guess),
              std::move(choices));
    }

    /// Looks up the names in the exit's condition.
    void check_condition(const Exit& exit) {
        if (exit.has(WhenRow::region)) region(exit.region, exit.place, "region");
        if (exit.when == When::lifted) {
            movable(exit.body, exit.place, "body");
        } else if (exit.has(WhenRow::body)) {
            body(exit.body, exit.place, "body");
        }
        if (exit.when == When::gripped && fingers_.size() < 2)
            error(exit.place, "when", "a grip takes two fingers, and the scene has one",
                  "Use when: touched.");
        if (exit.has(WhenRow::any_finger)) check_who(exit);
        if (exit.has(WhenRow::key) && !is_key(exit.key)) {
            error(exit.place, "key", fmt::format("'{}' is no key", exit.key),
                  "Write one letter or digit, e.g. key: y.");
        }
        if (exit.when == When::time && !exit.hold.computed() && exit.hold.value <= 0)
            error(exit.place, "after", "how long is missing", "Add e.g. after_s: 2.");
        if (exit.when == When::trigger && exit.hold != 0)
            error(exit.place, "hold", "a trigger is over at once", "Leave it out.");
    }

    /// Whose handle, or what, the condition judges.
    void check_who(const Exit& exit) {
        if (!exit.what.empty()) {
            const int i = look_up(plan_.quantities.things(), exit.what, exit.place, "what",
                                  "no body, finger or hand", diagnostics_);
            if (!exit.finger.empty())
                error(exit.place, "finger", "is said by what already", "Leave it out.");
            if (i >= 0 && exit.shown && plan_.quantities.thing(exit.what)->body >= 0)
                error(exit.place, "shown", "is said of fingers and hands, not of bodies",
                      "Leave it out.");
        }
        if (exit.finger.empty()) return;
        std::vector<std::string> known = fingers_;
        for (const Hand& hand : plan_.task.hands) known.push_back(hand.name);
        const int i = look_up(known, exit.finger, exit.place, "finger",
                              "none of the scene's fingers, and no hand of the task", diagnostics_);
        if (i < 0 || exit.when != When::gripped) return;
        if (plan_.quantities.thing(exit.finger)->fingers.count() < 2)
            error(exit.place, "finger",
                  fmt::format("a grip takes two fingers, and '{}' is one", exit.finger),
                  "Name a hand, or use when: touched.");
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
                cell.regions =
                    replaced(replaced(plan_.task.regions, round.regions), condition.regions);
                for (const Region& region : cell.regions)
                    cell.p_W.push_back(value(region.position));
                Diagnostics found;
                for (const PerturbationSpec& spec :
                     replaced(replaced(plan_.task.perturbations, round.perturbations),
                              condition.perturbations))
                    add_perturbation(cell, spec, found);
                cell.homes = homes({&round, &condition});
                note_formulas(cell);
                for (const Condition* of : {&round, &condition})
                    seen_.add_looks(of->look, cell.looks, found);
                for (const Problem& problem : found.problems()) {
                    if (said.insert(problem.text()).second) diagnostics_.add({problem});
                }
            }
        }
    }

    static void note_formulas(TaskPlan::Cell& cell) {
        const auto note = [&](auto& list) {
            for (auto& item : list) {
                each_formula(item, [&](const Formula& formula) {
                    if (formula.index >= 0) cell.formulas.push_back(formula.index);
                });
            }
        };
        note(cell.regions);
        note(cell.homes);
        note(cell.perturbations);
    }

    void add_perturbation(TaskPlan::Cell& cell, const PerturbationSpec& spec, Diagnostics& found) {
        const Perturbation& added =
            cell.perturbations.emplace_back(spec, cell.regions, scene_, found);
        for (const Load& load : added.loads())
            plan_.longest_delay = std::max(plan_.longest_delay, load.longest_delay());
        uint64_t& during = cell.during.emplace_back(0);
        const std::vector<State>& states = plan_.task.states;
        for (size_t i = 0; i < std::min(states.size(), TaskPlan::kMostStates); ++i) {
            if (spec.during.empty() && states[i].perturbed) during |= uint64_t{1} << i;
        }
        for (const std::string& name : spec.during) {
            const int i = look_up(names_of(states), name, spec.place, "during", "no state", found);
            if (i < 0 || i >= static_cast<int>(TaskPlan::kMostStates)) continue;
            during |= uint64_t{1} << i;
            if (!states[static_cast<size_t>(i)].perturbed)
                found.error(spec.place, "during",
                            fmt::format("nothing acts in '{}', which says perturbed: no", name),
                            "Leave out one of the two.");
        }
    }

    void check_reach() {
        if (!plan_.task.reach) return;
        const ReachMeasure& reach = *plan_.task.reach;
        check_fixed(region(reach.from, reach.place, "from"), reach.place, "from");
        check_fixed(region(reach.to, reach.place, "to"), reach.place, "to");
        look_up(names_of(plan_.task.states), reach.during, reach.place, "during", "no state",
                diagnostics_);
        if (!reach.finger.empty())
            look_up(fingers_, reach.finger, reach.place, "finger", "none of the scene's fingers",
                    diagnostics_);
        if (reach.axis && reach.axis->norm() <= 0)
            error(reach.place, "axis", "has no direction", "Write e.g. axis: [0, 0, 1].");
    }

    /// How a reach is measured is frozen before the session.
    void check_fixed(int region, const Place& place, const char* key) {
        if (region < 0) return;
        for (const TaskPlan::Cell& cell : plan_.cells) {
            for (const Formula& n : cell.regions[static_cast<size_t>(region)].position) {
                if (n.index < 0 || plan_.formulas[static_cast<size_t>(n.index)].expression.frozen())
                    continue;
                error(place, key, "names a region that variables move",
                      "Measure between regions that follow from draws and factors alone.");
                return;
            }
        }
    }

    TaskPlan::Home home(int index, const FormulaVec3& position) const {
        const scene::Body& body = scene_.bodies[static_cast<size_t>(index)];
        Pose X_WB = body.pose();
        X_WB.p = value(position);
        return {index, X_WB, scene::bounds(body.shape), position};
    }

    /// Whether any trial puts the body elsewhere than the scene has it.
    bool is_placed(const std::string& body) const {
        const auto among = [&](const auto& places) {
            return std::any_of(places.begin(), places.end(),
                               [&](const auto& place) { return place.body == body; });
        };
        const auto any = [&](const auto& list) {
            return std::any_of(list.begin(), list.end(),
                               [&](const auto& item) { return among(item.places); });
        };
        return any(plan_.task.conditions) || any(plan_.task.rounds) || any(plan_.task.states);
    }

    /// Where bodies begin a trial; places of later conditions replace those of earlier ones.
    std::vector<TaskPlan::Home> homes(std::initializer_list<const Condition*> conditions) const {
        std::vector<TaskPlan::Home> out;
        for (size_t i = 0; i < scene_.bodies.size(); ++i) {
            const scene::Body& body = scene_.bodies[i];
            if (!body.moves_at_all() && !body.driven && !is_placed(body.name)) continue;
            FormulaVec3 position = as_formula(body.position);
            FormulaVec3 velocity{};
            const BodyPlace* by_joint = nullptr;
            for (const Condition* condition : conditions) {
                for (const BodyPlace& place : condition->places) {
                    if (place.body == body.name && place.position) {
                        position = *place.position;
                        velocity = place.velocity.value_or(FormulaVec3{});
                        by_joint = nullptr;
                    }
                    if (moved_by(place) == static_cast<int>(i)) by_joint = &place;
                }
            }
            TaskPlan::Home& added = out.emplace_back(home(static_cast<int>(i), position));
            added.velocity = velocity;
            if (by_joint != nullptr) put_by_joint(*by_joint, added);
        }
        hang(out);
        return out;
    }

    const scene::Joint* joint_of(const BodyPlace& place) const {
        for (const scene::Joint& joint : scene_.joints) {
            if (joint.name == place.joint && joint.has_coordinate() && !joint.is_distance())
                return &joint;
        }
        return nullptr;
    }
    /// The body that a place by a joint is of; -1 if it is none.
    int moved_by(const BodyPlace& place) const {
        const scene::Joint* const joint = joint_of(place);
        return joint == nullptr ? -1 : scene_.find(joint->between.back());
    }
    void put_by_joint(const BodyPlace& place, TaskPlan::Home& home) const {
        const scene::Joint& joint = *joint_of(place);
        home.joint = on_joint(scene_, joint);
        home.coordinate = (joint.slides() ? place.displacement : place.angle).value_or(0.0);
        home.rate = joint.slides() ? place.speed : place.rate;
    }

    /// What hangs on a body that a joint places comes along; and each comes after what it hangs on.
    void hang(std::vector<TaskPlan::Home>& homes) const {
        const auto home_of = [&](int body) {
            return std::find_if(homes.begin(), homes.end(),
                                [body](const auto& home) { return home.body == body; });
        };
        std::vector<int> ordered;
        for (const TaskPlan::Home& home : homes) {
            if (home.joint) ordered.push_back(home.body);
        }
        for (size_t i = 0; i < ordered.size(); ++i) {
            for (const scene::Joint& joint : scene_.joints) {
                if (joint.between.size() < 2 || scene_.find(joint.between[0]) != ordered[i])
                    continue;
                const auto second = home_of(scene_.find(joint.between[1]));
                if (second == homes.end()) continue;
                if (!second->joint) {
                    second->joint = on_joint(scene_, joint);
                    ordered.push_back(second->body);
                }
            }
        }
        // by how many joints it is from what no joint places
        const auto depth = [&](const TaskPlan::Home& home) {
            size_t out = 0;
            for (auto at = home_of(home.body); at != homes.end() && at->joint && out < homes.size();
                 at = home_of(at->joint->first))
                ++out;
            return out;
        };
        std::vector<std::pair<size_t, TaskPlan::Home>> by_depth;
        for (const TaskPlan::Home& home : homes) by_depth.emplace_back(depth(home), home);
        std::stable_sort(by_depth.begin(), by_depth.end(),
                         [](const auto& a, const auto& b) { return a.first < b.first; });
        for (size_t i = 0; i < homes.size(); ++i) homes[i] = by_depth[i].second;
    }

    const scene::Scene& scene_;
    Diagnostics& diagnostics_;
    std::vector<std::string> regions_;
    std::vector<std::string> bodies_;
    std::vector<std::string> fingers_;
    TaskPlan plan_;
    SeenPlanner seen_;
};

}  // namespace

std::string conditions_with(const std::string& given, unsigned any) {
    std::vector<std::string> names;
    for (const WhenRow& row : kWhenTable) {
        if ((row.has & any) != 0) names.emplace_back(*row.name == 0 ? "an expression" : row.name);
    }
    if (const std::string guess = nearest(given, names); !guess.empty() && guess != given)
        return fmt::format("Did you mean when: {}?", guess);
    return fmt::format("It belongs to when: {}.", fmt::join(names, ", "));
}

std::vector<std::string> TaskPlan::phases() const {
    std::vector<std::string> out{"between trials"};
    for (const State& state : task.states) out.push_back(state.name);
    return out;
}

std::vector<int> TaskPlan::used_in(const Trial& trial) const {
    const Cell& cell = this->cell(trial);
    std::vector<int> out = in_states;
    out.insert(out.end(), cell.formulas.begin(), cell.formulas.end());
    return out;
}

double TaskPlan::largest(const Formula& number) const {
    if (number.index < 0) return number.value;
    const CompiledFormula& compiled = formulas[static_cast<size_t>(number.index)];
    return compiled.expression.foreseen() ? compiled.largest : compiled.formula.field.max;
}

TaskPlan plan_task(const Task& task, const scene::Scene& scene, Diagnostics& diagnostics) {
    return Planner(task, scene, diagnostics).plan();
}

Table frozen_list(const TaskPlan& plan, const scene::Scene& scene) {
    Table table = trial_list(plan.task, plan.trials);
    if (plan.task.reach) add_reaches(table, plan, scene);
    add_movements(table, plan, scene);
    return table;
}

Table procedure_table(const TaskPlan& plan) {
    std::vector<rows::ProcedureRow> out;
    for (const ProcedureSpec& p : plan.task.procedures) {
        out.push_back({p.name, std::string(p.kind()),
                       fmt::format("{}", fmt::join(p.perturb, kBetweenNames)), p.logarithmic, p.yes,
                       p.no, p.fitted(), p.known_shape().value_or(kUnmeasured), p.guess,
                       p.guess_is_lapse, p.level, p.standard.value_or(kUnmeasured)});
    }
    return figure_table<rows::ProcedureRow>(out);
}

}  // namespace dihaptic::task
