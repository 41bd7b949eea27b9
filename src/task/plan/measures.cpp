#include "task/plan/measures.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "base/figure.h"
#include "base/unmeasured.h"
#include "task/plan/lookup.h"
#include "task/plan/reach_plan.h"
#include "task/plan/task_plan.h"
#include "task/run/trial_numbers.h"

namespace dihaptic::task {
namespace {

template <class T>
size_t place_of(const std::vector<T>& list, const std::string& name) {
    const auto named = [&](const T& item) { return item.name == name; };
    return static_cast<size_t>(std::find_if(list.begin(), list.end(), named) - list.begin());
}

unsigned needs_of(const Task& task) {
    unsigned needs = 0;
    for (const std::string& name : task.measures) {
        if (const MeasureRow* row = measure_row(name)) needs |= row->needs;
    }
    return needs;
}

bool pushes_by_velocity(const PerturbationSpec& spec) {
    const std::vector<LoadSpec> loads = spec.all_loads();
    return std::any_of(loads.begin(), loads.end(),
                       [](const LoadSpec& load) { return load.pushes_by_velocity(); });
}

/// Whether the load acts on the finger, body or hand that is measured.
bool acts_on(const LoadSpec& load, const Movement& movement) {
    return movement.of == kHand ||
           std::find(load.on.begin(), load.on.end(), movement.of) != load.on.end();
}

/// Whether a load of the perturbation acts on the finger, body or hand that is measured.
bool acts_on(const PerturbationSpec& spec, const Movement& movement) {
    const std::vector<LoadSpec> loads = spec.all_loads();
    return movement.of == kHand ||
           std::any_of(loads.begin(), loads.end(),
                       [&](const LoadSpec& load) { return acts_on(load, movement); });
}

/// Returns the perturbation whose field defines the ideal force, or null if there is none.
const PerturbationSpec* ideal_of(const Task& task, const Movement& movement) {
    for (const PerturbationSpec& spec : task.perturbations) {
        if (movement.ideal.empty() ? pushes_by_velocity(spec) : spec.name == movement.ideal)
            return &spec;
    }
    return nullptr;
}

class MeasureChecker {
  public:
    MeasureChecker(const Task& task, const scene::Scene& scene, Diagnostics& diagnostics)
        : task_(task),
          scene_(scene),
          diagnostics_(diagnostics),
          movement_(movement_of(task, scene.fingers.empty() ? "" : scene.fingers.front().name)),
          place_(task.movement ? task.movement->place : task.place) {}

    void check() {
        check_list();
        const unsigned needs = needs_of(task_);
        if (task_.movement && task_.measures.empty())
            diagnostics_.warning(place_, "movement", "is not used by any measure",
                                 "Add e.g. measures: [reaction_time, peak_speed].");
        for (const auto& [key, name] : {std::pair{"go", &movement_.go}, {"step", &movement_.step}})
            if (!name->empty()) state(*name, key);
        if (needs & MeasureRow::movement) check_movement();
        if (needs & MeasureRow::channel) check_channel();
        if (needs & MeasureRow::ideal) check_ideal();
        if (needs & MeasureRow::grip) check_grip();
        if (!movement_.error.empty()) check_error();
        if (std::ranges::count(task_.measures, "reaction_time") > 0) check_pushes();
        if (task_.corrections) check_corrections(*task_.corrections);
        if ((needs & MeasureRow::step) && movement_.step.empty())
            error("step", "is missing, but grip_latency starts at a load step",
                  "Add movement: { step: name of the state that starts with the load step }.");
    }

  private:
    void error(const char* key, const std::string& what, const std::string& remedy) {
        diagnostics_.error(place_, key, what, remedy);
    }
    void state(const std::string& name, const char* key) {
        look_up(names_of(task_.states), name, place_, key, "not a state", diagnostics_);
    }

    /// Checks that there are trials to compare. The names in the spec are looked up elsewhere.
    void check_corrections(const CorrectionSpec& spec) {
        if (spec.axis.isZero(1e-9))
            diagnostics_.error(spec.place, "axis", "has no direction", "Write e.g. [1, 0, 0].");
        const auto perturbs = [](const auto& part) { return !part.perturb.empty(); };
        const auto any = [&](const Block& block) {
            return perturbs(block) || std::ranges::any_of(block.insert, perturbs);
        };
        if (spec.matched.empty() && std::ranges::none_of(task_.blocks, any) &&
            std::ranges::none_of(task_.procedures, perturbs))
            diagnostics_.error(
                spec.place, "matched",
                "is missing: no block has perturbations, so no trial differs from the others",
                "Name the conditions in which nothing happens.");
        if (!spec.matched.empty() && spec.matched.size() == task_.conditions.size())
            diagnostics_.error(spec.place, "matched", "names all conditions",
                               "Leave out those in which something happens.");
    }

    void check_list() {
        std::vector<std::string> names;
        for (const MeasureRow& row : kMeasureTable) names.emplace_back(row.name);
        for (size_t i = 0; i < task_.measures.size(); ++i) {
            const std::string& name = task_.measures[i];
            look_up(names, name, task_.place, "measures", "not a measure", diagnostics_);
            const auto end = task_.measures.begin() + static_cast<std::ptrdiff_t>(i);
            if (std::find(task_.measures.begin(), end, name) != end)
                diagnostics_.error(task_.place, "measures",
                                   fmt::format("'{}' is listed twice", name), "Leave one out.");
        }
    }

    void check_movement() {
        if (!task_.movement && !task_.reach) {
            error("movement", "is missing, but measures of movement are listed",
                  "Add e.g. movement: { from: start, to: target, during: [reach] }, with two "
                  "regions and a list of states.");
            return;
        }
        const std::vector<std::string> regions = names_of(task_.regions);
        for (const auto& [key, name] : {std::pair{"from", &movement_.from}, {"to", &movement_.to}})
            look_up(regions, *name, place_, key, "not a region", diagnostics_);
        if (movement_.from == movement_.to && !movement_.to.empty())
            error("to", "is the same region as 'from'", "Name two different regions.");
        if (movement_.during.empty())
            error("during", "is missing", "Name the states of the movement, e.g. during: [reach].");
        for (const std::string& name : movement_.during) state(name, "during");
        if (movement_.axis && movement_.axis->norm() <= 0)
            error("axis", "has no direction", "Write e.g. axis: [0, 0, 1].");
        check_what_moves();
        check_end();
    }

    /// Warns if the movement's states may be left before the hand has been still for long enough.
    void check_end() {
        const auto in = [&](const std::string& name) {
            return std::ranges::count(movement_.during, name) > 0;
        };
        for (const State& state : task_.states) {
            if (!in(state.name)) continue;
            for (const Exit& exit : state.exits) {
                const bool arrives = exit.when == When::inside || exit.when == When::still;
                const bool over = arrives && !exit.redo && !in(exit.to);
                if (!over || exit.hold.computed() || exit.hold.value >= movement_.end_still)
                    continue;
                diagnostics_.warning(
                    exit.place, "hold",
                    fmt::format("may end '{}' {:.3g} s after the hand has become still, but the "
                                "movement is over only after {:.3g} s (end_still): its end and "
                                "duration will then be missing",
                                state.name, exit.hold.value, movement_.end_still),
                    "Hold the condition for longer, shorten end_still, or list the state that "
                    "follows in 'during'.");
            }
        }
    }

    void check_what_moves() {
        std::vector<std::string> things = scene::finger_names(scene_);
        for (const scene::Body& body : scene_.bodies) {
            if (body.moves_at_all()) things.push_back(body.name);
        }
        things.emplace_back(kHand);
        look_up(things, movement_.of, place_, "of", "neither a finger, a movable body nor 'hand'",
                diagnostics_);
    }

    void check_channel() {
        const bool any = std::any_of(
            task_.perturbations.begin(), task_.perturbations.end(),
            [&](const auto& spec) { return is_channel(spec) && acts_on(spec, movement_); });
        if (!any)
            diagnostics_.error(
                task_.place, "measures",
                fmt::format("a channel force is listed, but no channel acts on '{}'", movement_.of),
                "Add a perturbation with field: { kind: channel, ... }, or set 'of' in 'movement' "
                "to the finger or body in the channel.");
    }

    void check_ideal() {
        const PerturbationSpec* ideal = ideal_of(task_, movement_);
        if (ideal == nullptr && movement_.ideal.empty()) {
            error("ideal", "is missing: adaptation_index needs a field that is learned",
                  "Add a perturbation with a curl or viscous field.");
        } else if (ideal == nullptr) {
            look_up(names_of(task_.perturbations), movement_.ideal, place_, "ideal",
                    "not a perturbation", diagnostics_);
        } else if (!pushes_by_velocity(*ideal) || !acts_on(*ideal, movement_)) {
            error("ideal",
                  fmt::format("'{}' has no velocity-dependent field on '{}'", ideal->name,
                              movement_.of),
                  "Name a perturbation with a curl or viscous field on the finger or body that is "
                  "measured.");
        }
    }

    /// Warns of constant forces that begin to push the hand at the go signal.
    void check_pushes() {
        const std::string& go = movement_.go.empty() && !movement_.during.empty()
                                    ? movement_.during.front()
                                    : movement_.go;
        for (const PerturbationSpec& spec : task_.perturbations) {
            if (!begins_in(spec, go) || (spec.profile && spec.profile->delay != 0)) continue;
            for (const LoadSpec& load : spec.all_loads()) {
                if (load.kind != LoadKind::constant || !acts_on(load, movement_)) continue;
                diagnostics_.warning(
                    load.place, "on",
                    fmt::format("pushes the hand from the moment at which '{}' begins: "
                                "reaction_time may be that of the push, not of the person",
                                go),
                    "Compare it only among trials with the same push, or let the push begin in "
                    "another state.");
            }
        }
    }
    /// Whether a perturbation acts in this state, and in no state from which this one is entered.
    bool begins_in(const PerturbationSpec& spec, const std::string& state) const {
        const auto acts_in = [&](const std::string& name) {
            return std::ranges::count(spec.during, name) > 0;
        };
        return acts_in(state) && std::ranges::none_of(task_.states, [&](const State& other) {
                   const bool leads = std::ranges::any_of(
                       other.exits, [&](const Exit& exit) { return exit.to == state; });
                   return leads && other.name != state && acts_in(other.name);
               });
    }

    void check_grip() {
        if (scene_.object_index() >= 0 && scene_.fingers.size() > 1) return;
        diagnostics_.error(task_.place, "measures",
                           "measures of grip need a movable object and two fingers",
                           "Leave them out, or use a scene with both.");
    }

    void check_error() {
        if (!error_column(task_.measures, movement_.error).empty()) return;
        std::vector<std::string> names;
        for (const std::string& name : task_.measures) {
            const MeasureRow* row = measure_row(name);
            for (const MeasureColumn& column : row ? row->columns : decltype(row->columns){}) {
                if (column.name != nullptr) names.emplace_back(column.name);
            }
        }
        look_up(names, movement_.error, place_, "error", "not a value of the listed measures",
                diagnostics_);
    }

    const Task& task_;
    const scene::Scene& scene_;
    Diagnostics& diagnostics_;
    Movement movement_;
    Place place_;
};

/// Whether the load is a channel that prevents lateral motion, rather than a plane that contains
/// the movement. `regions_W` are the centres of the regions [m].
bool holds_to_line(const Load& load, std::span<const Vec3> regions_W,
                   const MovementPlan& movement) {
    constexpr double kAside = 1e-3;  // [m]
    if (load.spec().kind != LoadKind::channel) return false;
    const Vec3 left = movement.left_W();
    if (left.hasNaN()) return true;
    const auto force_at = [&](const Vec3& p_W) {
        return load.act(1, regions_W, {p_W, Vec3::Zero()}).force.dot(left);
    };
    return force_at(movement.from_W) - force_at(movement.from_W + kAside * left) >
           load.stiffness() * kAside / 2;
}

/// Compares the trial's perturbations with the ideal field, and determines whether one of them is a
/// channel. `cell` is that of the trial, with its numbers resolved.
void compare(MovementPlan& out, const Task& task, const TaskPlan::Cell& cell, const Trial& trial,
             const Movement& movement) {
    const PerturbationSpec* ideal = ideal_of(task, movement);
    if (ideal != nullptr) {
        const auto& field = cell.perturbations[place_of(task.perturbations, ideal->name)];
        out.ideal = field.field_gain();
        out.ideal_delay = field.field_delay();
    }
    out.channel = 0;
    out.channel_states = 0;
    out.field_share = 0;
    Mat3 gain = Mat3::Zero();
    for (const int p : trial.perturb) {
        const auto i = static_cast<size_t>(p);
        const std::span<const Load> loads = cell.perturbations[i].loads();
        const bool holds = std::any_of(loads.begin(), loads.end(), [&](const Load& load) {
            return acts_on(load.spec(), movement) && holds_to_line(load, cell.p_W, out);
        });
        if (holds) {
            out.channel = 1;
            out.channel_states |= cell.during[i];
        }
        gain += cell.perturbations[i].field_gain();
    }
    if (out.channel == 1) {
        out.field_share = kUnmeasured;
    } else if (ideal != nullptr && !gain.isZero(0)) {
        out.field_share = gain.cwiseProduct(out.ideal).sum() / out.ideal.squaredNorm();
    }
}

}  // namespace

const MeasureRow* measure_row(const std::string& name) {
    const auto named = [&](const MeasureRow& row) { return row.name == name; };
    const auto found = std::find_if(std::begin(kMeasureTable), std::end(kMeasureTable), named);
    return found == std::end(kMeasureTable) ? nullptr : found;
}

std::vector<Table::Column> columns_of_measure(const MeasureRow& row) {
    FigureLister out;
    for (const MeasureColumn& column : row.columns) {
        if (column.name != nullptr) out(column.name, 0.0, column.unit, column.what);
    }
    return out.columns;
}

std::string error_column(const std::vector<std::string>& measures, const std::string& error) {
    for (const std::string& name : measures) {
        const MeasureRow* row = measure_row(name);
        if (row == nullptr) continue;
        const std::vector<Table::Column> columns = columns_of_measure(*row);
        for (size_t i = 0; i < columns.size(); ++i) {
            if (row->columns[i].name == error) return columns[i].name;
        }
    }
    return "";
}

uint64_t states_of(const CustomMeasure& measure) {
    if (measure.during.empty()) return ~uint64_t{0};
    uint64_t out = 0;
    for (const int state : measure.during.indices) out |= uint64_t{1} << state;
    return out;
}

Table::Column not_measured_column() {
    return {kNotMeasured, "measures that are missing, and the reasons"};
}

std::vector<Table::Column> measure_columns() {
    std::vector<Table::Column> out;
    for (const MeasureRow& row : kMeasureTable) {
        for (Table::Column& column : columns_of_measure(row)) out.push_back(std::move(column));
    }
    out.push_back(not_measured_column());
    return out;
}

Vec3 MovementPlan::left_W() const {
    constexpr double kAlong = 1e-9;
    const Vec3 left = axis_W.cross(along_W());
    if (!(left.norm() > kAlong * axis_W.norm())) return Vec3::Constant(kUnmeasured);
    return left.normalized();
}

Movement movement_of(const Task& task, const std::string& first_finger) {
    Movement out = task.movement.value_or(Movement{});
    const auto fill = [](std::string& own, const std::string& other) {
        if (own.empty()) own = other;
    };
    if (task.reach) {
        fill(out.of, task.reach->finger);
        fill(out.from, task.reach->from);
        fill(out.to, task.reach->to);
        if (out.during.empty())
            out.during.assign(task.reach->during.begin(), task.reach->during.end());
        if (!out.axis) out.axis = task.reach->axis;
    }
    fill(out.of, first_finger);
    return out;
}

void check_measures(const TaskPlan& plan, const scene::Scene& scene, Diagnostics& diagnostics) {
    MeasureChecker(plan.task, scene, diagnostics).check();
}

std::vector<MovementPlan> movements_of(const TaskPlan& plan, const scene::Scene& scene) {
    std::vector<MovementPlan> list;
    if ((needs_of(plan.task) & MeasureRow::movement) == 0) return list;
    const Movement movement = movement_of(plan.task, scene.fingers.front().name);
    const size_t from = place_of(plan.task.regions, movement.from);
    const size_t to = place_of(plan.task.regions, movement.to);
    TrialNumbers numbers(plan);
    for (size_t i = 0; i < plan.trials.size(); ++i) {
        numbers.begin(static_cast<int>(i), 1, plan.start);
        const TaskPlan::Cell& cell = numbers.cell();
        MovementPlan& out = list.emplace_back();
        out.from_W = cell.p_W[from];
        out.to_W = cell.p_W[to];
        out.axis_W = movement.axis ? movement.axis->normalized() : usual_axis(cell);
        compare(out, plan.task, cell, plan.trials[i], movement);
    }
    return list;
}

void add_movements(Table& list, const TaskPlan& plan, const scene::Scene& scene) {
    if ((needs_of(plan.task) & MeasureRow::movement) == 0) return;
    add_columns<MovementPlan>(list);
    const std::vector<MovementPlan> movements = movements_of(plan, scene);
    for (size_t i = 0; i < movements.size(); ++i) add_cells(list.rows[i], movements[i]);
}

std::vector<MovementPlan> read_movements(const std::string& file) {
    const rows::RowFile<MovementPlan> list(file);
    if (!list.column(kFirstMovementColumn)) return {};
    return {list.begin(), list.end()};
}

}  // namespace dihaptic::task
