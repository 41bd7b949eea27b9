#include "analysis/measures/measures.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "analysis/perturbations.h"
#include "base/figure.h"
#include "base/unmeasured.h"

namespace dihaptic::analysis {
namespace {

int index_of(const std::vector<std::string>& names, const std::string& name) {
    const auto found = std::find(names.begin(), names.end(), name);
    return found == names.end() ? -1 : static_cast<int>(found - names.begin());
}

/// Converts a value to the unit of its column.
double in_unit(const task::MeasureColumn& column, double value) {
    return value * figure_form(column.name, column.unit).scale;
}

size_t place_of(const Table& table, const char* name) {
    const auto named = [&](const Table::Column& c) { return c.name == name; };
    return static_cast<size_t>(std::find_if(table.columns.begin(), table.columns.end(), named) -
                               table.columns.begin());
}

struct Planned {
    scene::Scene scene;
    task::TaskPlan plan;
};

/// Returns the session's plan with its trials; nullopt if this version of the program cannot make
/// the plan.
std::optional<Planned> planned(const task::Task& task, const recording::SessionFolder& folder) {
    Diagnostics problems(UnknownKeys::are_left_out);
    scene::Scene scene = scene::read_scene(folder.file("scene.yaml"), problems);
    task::TaskPlan plan = task::plan_task(task, scene, problems);
    if (problems.has_errors()) return std::nullopt;
    plan.trials = task::read_trial_list(plan.task, folder.file("trial-list.csv"));
    return Planned{std::move(scene), std::move(plan)};
}

/// Finds the states in which channels act in the trials with movements, and the delay of the ideal
/// force.
void find_channels(const Planned& of, std::vector<task::MovementPlan>& movements) {
    const std::vector<task::MovementPlan> known = task::movements_of(of.plan, of.scene);
    for (size_t i = 0; i < std::min(known.size(), movements.size()); ++i) {
        movements[i].channel_states = known[i].channel_states;
        movements[i].ideal_delay = known[i].ideal_delay;
    }
}

}  // namespace

std::vector<Table::Column> measure_columns_of(const task::Task& task) {
    std::vector<Table::Column> out = task::measure_columns();
    const auto own = task::columns_of(task.custom_measures);
    out.insert(out.end() - 1, own.begin(), own.end());
    return out;
}

std::optional<MeasureFinder> MeasureFinder::of(const recording::SessionFolder& folder,
                                               const recording::LogHead& head,
                                               const std::vector<std::string>& phases) try {
    const task::Task task = read_frozen_task(folder.file("task.yaml"));
    MeasureFinder out;
    for (const std::string& name : task.measures) {
        if (const task::MeasureRow* row = task::measure_row(name)) out.measures_.push_back(row);
    }
    out.custom_measures_ = task.custom_measures;
    out.plans_ = task::read_movements(folder.file("trial-list.csv"));
    out.plan_with(task, folder);
    if (out.measures_.empty() && !out.own_) return std::nullopt;
    out.options_ = movement_of(task, head.fingers.empty() ? "" : head.fingers.front());
    const std::vector<std::string>& during = out.options_.during;
    for (const std::string& name : during) out.phases_.during.push_back(index_of(phases, name));
    const std::string go = !out.options_.go.empty() ? out.options_.go
                           : during.empty()         ? ""
                                                    : during.front();
    out.phases_.go = index_of(phases, go);
    out.phases_.step = index_of(phases, out.options_.step);
    out.finger_ = index_of(head.fingers, out.options_.of);
    if (out.finger_ < 0) out.body_ = index_of(head.bodies, out.options_.of);
    out.tick_ = head.tick;
    return out;
} catch (const Error&) {
    return std::nullopt;
}

/// Plans the task to obtain what trial-list.csv does not contain.
void MeasureFinder::plan_with(const task::Task& task, const recording::SessionFolder& folder) {
    const bool in_channels = std::ranges::any_of(
        plans_, [](const task::MovementPlan& plan) { return plan.channel != 0; });
    if (!in_channels && custom_measures_.empty()) return;
    std::optional<Planned> known = planned(task, folder);
    if (!known) return;
    find_channels(*known, plans_);
    if (!custom_measures_.empty())
        own_ = std::make_unique<task::CustomMeasures>(std::move(known->plan));
}

MotionSample MeasureFinder::sample(const frame::Frame& frame) const {
    MotionSample out{seconds(frame.time), frame.phase,      Vec3::Zero(), Vec3::Zero(),
                     Vec3::Zero(),        frame.grip_force, true};
    out.continues = frame.sequence == sequence_ + 1 && (frame.status & kResumed) == 0;
    if (body_ >= 0) {
        const frame::BodyFrame& body = frame.bodies[static_cast<size_t>(body_)];
        out.p_W = body.X_WB.p;
        out.v_W = body.v_WB;
        for (const frame::LoadFrame& load : frame.task.loads) {
            if (load.body == body_) out.f_W -= load.force_W;
        }
        return out;
    }
    const auto count = static_cast<double>(frame.fingers.size());
    for (size_t i = 0; i < frame.fingers.size(); ++i) {
        if (finger_ >= 0 && i != static_cast<size_t>(finger_)) continue;
        const double share = finger_ >= 0 ? 1 : 1 / count;
        out.p_W += share * frame.fingers[i].p_WH;
        out.v_W += share * frame.fingers[i].v_WH;
        out.f_W -= frame.fingers[i].f_sent_W;
    }
    return out;
}

void MeasureFinder::add(const frame::Frame& frame) {
    if (frame.trial >= 1 && frame.phase != 0) {
        trial_ = frame.trial;
        number_ = frame.task.attempt;
        attempt_.share = std::fmax(attempt_.share, frame.task.share);
        attempt_.samples.push_back(sample(frame));
        if (own_) own_->add(frame);
    }
    sequence_ = frame.sequence;
}

void MeasureFinder::end_attempt(const rows::LiftRow* lift) {
    if (attempt_.samples.empty()) return;
    const auto i = static_cast<size_t>(trial_ - 1);
    attempt_.plan = i < plans_.size() ? plans_[i] : task::MovementPlan{};
    attempt_.lift = lift;
    const AttemptMeasures found(attempt_, options_, phases_, tick_);
    Row& row = rows_.emplace_back();
    row.trial = trial_;
    row.number = number_;
    std::string missing;
    for (const task::MeasureRow* measure : measures_) {
        const MeasuredValues of = found.measure(*measure);
        for (size_t k = 0; k < of.values.size(); ++k)
            row.cells.emplace_back(in_unit(measure->columns[k], of.values[k]));
        if (!of.why.empty())
            missing += (missing.empty() ? "" : "; ") + std::string(measure->name) + ": " + of.why;
    }
    const std::vector<double> own = own_ ? own_->end_attempt() : std::vector<double>{};
    for (size_t k = 0; k < own.size(); ++k) {
        row.cells.emplace_back(own[k]);
        if (std::isnan(own[k]))
            missing += (missing.empty() ? "" : "; ") + custom_measures_[k].name + ": " +
                       (custom_measures_[k].window
                            ? fmt::format("its states were shorter than its window of {:g} s",
                                          *custom_measures_[k].window)
                            : "not measured");
    }
    row.cells.emplace_back(missing);
    attempt_.samples.clear();
    attempt_.share = 0;
}

void MeasureFinder::add_to(Table& trials) const {
    const size_t trial = place_of(trials, "trial_num");
    const size_t number = place_of(trials, "attempt");
    for (const task::MeasureRow* measure : measures_) {
        for (Table::Column& column : task::columns_of_measure(*measure))
            trials.columns.push_back(std::move(column));
    }
    if (own_) {
        const auto own = task::columns_of(custom_measures_);
        trials.columns.insert(trials.columns.end(), own.begin(), own.end());
    }
    trials.columns.push_back(task::not_measured_column());
    std::map<std::pair<double, double>, const Row*> rows;
    for (const Row& row : rows_) rows[{row.trial, row.number}] = &row;
    for (std::vector<Table::Cell>& cells : trials.rows) {
        const auto of = [&](size_t column) {
            const double* value = std::get_if<double>(&cells[column]);
            return value != nullptr ? *value : -1;
        };
        const auto found = rows.find({of(trial), of(number)});
        if (found != rows.end()) {
            const std::vector<Table::Cell>& own = found->second->cells;
            cells.insert(cells.end(), own.begin(), own.end());
        } else {
            cells.resize(trials.columns.size() - 1, kUnmeasured);
            cells.emplace_back("not recorded");
        }
    }
}

}  // namespace dihaptic::analysis
