#include "analysis/trials.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <set>

#include "base/figure.h"
#include "base/number.h"
#include "base/regular_file.h"
#include "base/text_file.h"
#include "base/unit.h"
#include "base/unmeasured.h"
#include "frame/displayed.h"
#include "task/plan/measures.h"
#include "task/plan/trials.h"

namespace dihaptic::analysis {
namespace {

constexpr const char* kList = "trial-list.csv";
constexpr const char* kBefore = "trials-before.csv";
constexpr double kPerDegree = 1 / kDegree;  // factor from radians to degrees
constexpr double kPerMm = 1000;             // factor from m to mm

/// Description of a column that comes from trial-list.csv.
std::string listed_as(const std::string& name) {
    for (const Table::Column& c : list_figures(rows::AskedRow{}).columns) {
        if (c.name == name) return c.description;
    }
    return "column of trial-list.csv";
}

/// Returns the index of the column in the list, or the number of columns if there is no such
/// column.
size_t column(const std::vector<std::vector<std::string>>& list, const std::string& name) {
    return static_cast<size_t>(std::find(list[0].begin(), list[0].end(), name) - list[0].begin());
}

template <class T, class More>
void append(std::vector<T>& list, const More& more) {
    list.insert(list.end(), more.begin(), more.end());
}

/// Converts a text to a number only if it is exactly as this program would write the number; a
/// block called 007 or nan remains text.
Table::Cell cell(const std::string& text) {
    const auto value = any_number(text);
    return value && to_csv(Table::Cell(*value)) == text ? Table::Cell(*value) : Table::Cell(text);
}

/// Throws Error when the list would give the table columns that have the same name or that
/// session.nwb cannot contain.
void check_columns(const Table& table, const std::string& list) {
    std::set<std::string> names;
    for (const Table::Column& column : table.columns) {
        const bool usable = !column.name.empty() && column.name != "." &&
                            column.name.find('/') == std::string::npos;
        if (usable && names.insert(column.name).second) continue;
        throw Error({list, 1}, shortened(column.name),
                    usable ? "is the name of two columns" : "is not a valid column name",
                    "Restore the list with which the session was recorded.");
    }
}

/// Cells with the values of the numbers in the first and last tick of the trial.
std::vector<Table::Cell> cells_of_numbers(const recording::SessionInfo& info,
                                          const std::vector<frame::VariableFrame>& first,
                                          const std::vector<frame::VariableFrame>& last,
                                          const std::vector<frame::VariableFrame>& decided) {
    std::vector<Table::Cell> out;
    size_t i = 0;
    const auto add = [&](const std::string& name, const auto& values) {
        out.emplace_back(i < values.size() ? values[i].value / split_unit(name).si : kUnmeasured);
    };
    for (const std::string& name : info.variables) {
        add(name, first);
        add(name, decided.empty() ? last : decided);
        ++i;
    }
    for (const std::string& name : info.levels) {
        add(name, first);
        ++i;
    }
    for (const std::string& name : info.answers) {
        add(name, last);
        ++i;
    }
    return out;
}

}  // namespace

std::vector<NumberColumn> columns_of_numbers(const recording::SessionInfo& info) {
    std::vector<NumberColumn> out;
    for (const std::string& name : info.variables) {
        out.push_back({{name, "variable, in the trial"}, true});
        out.push_back({{task::next_column(name), "variable, after the trial"}, false});
    }
    for (const std::string& name : info.levels)
        out.push_back({{name, "chosen by a procedure"}, true});
    for (const std::string& name : info.answers) out.push_back({{name, "answered"}, false});
    return out;
}

double angle_about(const Vec3& axis, const Vec3& from, const Vec3& to) {
    const Vec3 a = from - from.dot(axis) * axis;
    const Vec3 b = to - to.dot(axis) * axis;
    constexpr double kAlong = 1e-9;
    if (a.norm() <= kAlong * from.norm() || b.norm() <= kAlong * to.norm()) return kUnmeasured;
    return std::atan2(axis.dot(a.cross(b)), a.dot(b));
}

bool has_trials(const recording::SessionFolder& folder) {
    return is_there(folder.file(kList));
}

TrialFinder::TrialFinder(const recording::SessionFolder& folder,
                         const std::vector<std::string>& fingers)
    : file_(folder.file(kList)), list_(read_csv(file_)) {
    for (const task::ReachPlan& plan : task::read_reaches(folder.file(kList))) {
        if (plan.finger.empty()) {
            throw Error({folder.file(kList), static_cast<int>(reaches_.size()) + 2},
                        task::kFirstReachColumn, "is missing: the line is cut off",
                        "Restore the list with which the session was recorded.");
        }
        const auto named = std::find(fingers.begin(), fingers.end(), plan.finger);
        const auto finger = static_cast<size_t>(named - fingers.begin());
        reaches_.push_back({plan, finger < fingers.size() ? finger : 0, plan.phase_numbers()});
    }
}

void TrialFinder::add(const frame::Frame& frame) {
    if (frame.trial < 1) return;
    if (frame.phase == 0) {  // variables may be set between trials
        if (!rows_.empty()) rows_.back().decided = frame.task.variables;
        return;
    }
    if (rows_.empty() || rows_.back().trial != frame.trial ||
        rows_.back().measures.attempt != frame.task.attempt) {
        if (!rows_.empty()) rows_.back().decided = frame.task.variables;
        Row row;
        row.trial = frame.trial;
        row.measures.attempt = frame.task.attempt;
        row.start = seconds(frame.time);
        row.variables = frame.task.variables;
        rows_.push_back(row);
    }
    Row& row = rows_.back();
    row.end = seconds(frame.time);
    row.last = frame.task.variables;
    if (frame.task.outcome >= 0) row.outcome = frame.task.outcome;
    // keeps the last nonzero share, since a perturbation may act in only part of the trial
    if (frame.task.share != 0) row.share = frame.task.share;
    rows::TrialMeasures& m = row.measures;
    m.peak_grip = std::fmax(m.peak_grip, frame.grip_force);
    for (const frame::FingerFrame& finger : frame.fingers)
        m.peak_force = std::max(m.peak_force, finger.f_sent_W.norm());

    const auto i = static_cast<size_t>(frame.trial - 1);
    if (i >= reaches_.size() || !std::isnan(m.reach_time)) return;
    const std::vector<int>& phases = reaches_[i].phases;
    if (std::find(phases.begin(), phases.end(), frame.phase) == phases.end()) return;
    if (reaches_[i].plan.measure == task::Measure::extent) {
        measure_extent(row, reaches_[i], frame);
    } else {
        measure_angle(row, reaches_[i], frame);
    }
}

void TrialFinder::measure_angle(Row& row, const Reach& reach, const frame::Frame& frame) const {
    const Vec3 arm = frame.fingers[reach.finger].p_WH - reach.plan.from_W;
    if (arm.norm() < reach.plan.distance) return;
    const Vec3 way = reach.plan.to_W - reach.plan.from_W;
    row.measures.reach_time = row.end - row.start;
    row.measures.hand_angle_deg = kPerDegree * angle_about(reach.plan.axis_W, way, arm);
    const Vec3 shown = frame::displayed_handle(frame, reach.finger).p - reach.plan.from_W;
    row.measures.shown_angle_deg = kPerDegree * angle_about(reach.plan.axis_W, way, shown);
}

/// Extents are measured from the starting position of the handle, because a finger that holds an
/// object is not at the middle of the hand. The wanted extent is the part of the path between the
/// regions that is still to be covered.
void TrialFinder::measure_extent(Row& row, const Reach& reach, const frame::Frame& frame) const {
    const frame::FingerFrame& finger = frame.fingers[reach.finger];
    const Vec3 shown_W = frame::displayed_handle(frame, reach.finger).p;
    if (!row.hand_start_W) {
        row.hand_start_W = finger.p_WH;
        row.shown_start_W = shown_W;
    }
    const Vec3 way = reach.plan.to_W - reach.plan.from_W;
    const Vec3 along = way.normalized();
    if (!row.stroke.add(finger.v_WH.dot(along))) return;
    row.measures.reach_time = row.end - row.start;
    row.measures.hand_extent_mm = kPerMm * (finger.p_WH - *row.hand_start_W).dot(along);
    row.measures.shown_extent_mm = kPerMm * (shown_W - row.shown_start_W).dot(along);
    row.measures.wanted_extent_mm = kPerMm * way.norm();
}

Table TrialFinder::table(const recording::SessionInfo& info) const {
    Table table;
    add_columns<rows::TrialHead>(table);
    // the columns that say how a trial is measured are not repeated
    const size_t listed =
        std::min(column(list_, task::kFirstReachColumn), column(list_, task::kFirstMovementColumn));
    for (size_t k = 0; k < listed; ++k)
        table.columns.push_back({list_[0][k], listed_as(list_[0][k])});
    for (NumberColumn& column : columns_of_numbers(info))
        table.columns.push_back(std::move(column));
    add_columns<rows::TrialMeasures>(table);
    check_columns(table, file_);
    for (const Row& r : rows_) {
        std::vector<Table::Cell> row =
            list_figures(rows::TrialHead{r.start, r.end, info.title, info.participant.id}).cells;
        const auto i = static_cast<size_t>(r.trial);
        for (size_t k = 0; k < listed; ++k) {
            const bool known = i < list_.size() && k < list_[i].size();
            // the share chosen by a procedure is known only once the trial is done
            if (known && list_[0][k] == "share" && list_[i][k].empty()) {
                row.emplace_back(r.share);
            } else {
                row.push_back(cell(known ? list_[i][k] : ""));
            }
        }
        append(row, cells_of_numbers(info, r.variables, r.last, r.decided));
        const auto outcome = static_cast<size_t>(r.outcome);
        rows::TrialMeasures measures = r.measures;
        measures.outcome = r.outcome >= 0 && outcome < info.outcomes.size() ? info.outcomes[outcome]
                                                                            : rows::kInterrupted;
        add_cells(row, measures);
        table.rows.push_back(row);
    }
    return table;
}

size_t TrialFinder::ended() const {
    return static_cast<size_t>(
        std::ranges::count_if(rows_, [](const Row& row) { return row.outcome >= 0; }));
}

std::vector<Table::Column> trial_columns() {
    std::vector<Table::Column> out = list_figures(rows::TrialRow{}).columns;
    out.push_back(kPartnerColumn);
    append(out, recording::kMovedByColumns);
    return out;
}

int sessions_before(const recording::SessionFolder& folder) {
    if (!is_there(folder.file(kBefore))) return 0;
    int last = 1;
    for (const rows::TrialRow& row : rows::TrialFile(folder.file(kBefore)))
        last = std::max(last, row.head.session);
    return last;
}

void number_session(Table& own, const recording::SessionFolder& folder) {
    const int last = sessions_before(folder);
    if (last == 0) return;
    const auto number = static_cast<size_t>(
        std::find_if(own.columns.begin(), own.columns.end(),
                     [](const Table::Column& c) { return c.name == "session_num"; }) -
        own.columns.begin());
    for (std::vector<Table::Cell>& row : own.rows) row.at(number) = last + 1.0;
}

Table with_earlier(const Table& own, const recording::SessionFolder& folder) {
    if (!is_there(folder.file(kBefore))) return own;
    const auto before = read_csv(folder.file(kBefore));
    const size_t outcome = column(before, "outcome");
    const size_t number = column(before, "session_num");
    if (outcome == before[0].size() || number == before[0].size()) {
        throw Error({folder.file(kBefore), 1}, "", "has no columns 'outcome' and 'session_num'",
                    "Replace it with the trials.csv of the session that this one resumes.");
    }
    Table table{own.columns, {}};
    // the table of an earlier version may lack a column, or have it in another position
    std::vector<size_t> places;
    for (const Table::Column& c : own.columns) places.push_back(column(before, c.name));
    for (size_t i = 1; i < before.size(); ++i) {
        if (before[i].size() != before[0].size()) continue;
        if (before[i][outcome] == rows::kInterrupted) continue;  // repeated in this session
        std::vector<Table::Cell>& row = table.rows.emplace_back();
        for (const size_t place : places)
            row.push_back(cell(place < before[i].size() ? before[i][place] : ""));
    }
    table.rows.insert(table.rows.end(), own.rows.begin(), own.rows.end());
    return table;
}

}  // namespace dihaptic::analysis
