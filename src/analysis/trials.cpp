#include "analysis/trials.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <numbers>

#include "base/regular_file.h"
#include "base/unmeasured.h"
#include "recording/trial_list.h"
#include "servo/displayed.h"

namespace dihaptic::analysis {
namespace {

constexpr const char* kList = "trial-list.csv";
constexpr const char* kBefore = "trials-before.csv";
constexpr const char* kInterrupted = "interrupted";
constexpr double kMostPhases = 1e6;
constexpr double kDegrees = 180 / std::numbers::pi;

const std::vector<Table::Column> kSessionColumns = {
    {"start_time", "of the session [s]"},
    {"stop_time", "of the session [s]"},
    {"experiment", "title"},
    {"ppid", "participant"},
    {"session_num", "number, from 1; a session that goes on with another has the next"}};

const std::vector<Table::Column> kMeasureColumns = {
    {"attempt", "at the trial, from 1"},
    {"outcome", "what ended it; interrupted: nothing did"},
    {"peak_grip_N", "largest grip force"},
    {"peak_force_N", "largest force on any finger"},
    {"reach_time_s", "from its start until the reach was measured"},
    {"hand_angle_deg", "of the handle then, from the target's direction, about the axis"},
    {"shown_angle_deg", "the same of where the handle was shown"},
    {"hand_extent_mm", "of the handle's first stroke, toward the target"},
    {"shown_extent_mm", "the same of where the handle was shown"},
    {"wanted_extent_mm", "that would have led to the target"}};

/// Description of a column of the list.
std::string listed_as(const std::string& name) {
    for (const Table::Column& c : recording::kTrialListColumns) {
        if (c.name == name) return c.description;
    }
    return "of trial-list.csv";
}

/// Index of the list's column; its number of columns if there is no such column.
size_t column(const std::vector<std::vector<std::string>>& list, const std::string& name) {
    return static_cast<size_t>(std::find(list[0].begin(), list[0].end(), name) - list[0].begin());
}

Table::Cell cell(const std::string& text) {
    char* end = nullptr;
    const double value = std::strtod(text.c_str(), &end);
    return !text.empty() && *end == '\0' ? Table::Cell(value) : Table::Cell(text);
}

}  // namespace

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
    : list_(read_csv(folder.file(kList))) {
    const size_t first = column(list_, "reach_finger");
    if (first == list_[0].size()) return;
    for (size_t i = 1; i < list_.size(); ++i) {
        const auto& row = list_[i];
        if (row.size() <= first) {
            throw Error({folder.file(kList), static_cast<int>(i) + 1}, "reach_finger",
                        "is missing: the line is cut off",
                        "Put back the list that the session was recorded with.");
        }
        const auto number = [&](size_t k) {
            return first + k < row.size() ? std::strtod(row[first + k].c_str(), nullptr)
                                          : kUnmeasured;
        };
        const auto vector = [&](size_t k) { return Vec3(number(k), number(k + 1), number(k + 2)); };
        ReachPlan reach;
        const auto finger = std::find(fingers.begin(), fingers.end(), row[first]);
        reach.finger = finger == fingers.end() ? 0 : static_cast<size_t>(finger - fingers.begin());
        reach.distance = number(1) * 1e-3;
        reach.from_W = vector(2) * 1e-3;
        reach.to_W = vector(5) * 1e-3;
        reach.axis_W = vector(8);
        const double phase = number(11);
        reach.phase = phase >= 0 && phase < kMostPhases ? static_cast<int>(phase) : -1;
        reach.extent = first + 12 < row.size() && row[first + 12] == "extent";
        reaches_.push_back(reach);
    }
}

void TrialFinder::add(const servo::Frame& frame) {
    if (frame.trial < 1 || frame.phase == 0) return;  // between trials
    if (rows_.empty() || rows_.back().trial != frame.trial ||
        rows_.back().attempt != frame.task.attempt) {
        Row row;
        row.trial = frame.trial;
        row.attempt = frame.task.attempt;
        row.start = seconds(frame.time);
        row.peak_grip = row.hand_angle = row.shown_angle = row.reach_time = kUnmeasured;
        row.hand_extent = row.shown_extent = row.wanted_extent = kUnmeasured;
        rows_.push_back(row);
    }
    Row& row = rows_.back();
    row.end = seconds(frame.time);
    if (frame.task.outcome >= 0) row.outcome = frame.task.outcome;
    // kept, since the perturbation may not act in all of the trial
    if (frame.task.share != 0) row.share = frame.task.share;
    row.peak_grip = std::fmax(row.peak_grip, frame.grip_force);
    for (const servo::FingerFrame& finger : frame.fingers)
        row.peak_force = std::max(row.peak_force, finger.f_sent_W.norm());

    const auto i = static_cast<size_t>(frame.trial - 1);
    if (i >= reaches_.size() || !std::isnan(row.reach_time)) return;
    if (frame.phase != reaches_[i].phase) return;
    if (reaches_[i].extent) {
        measure_extent(row, reaches_[i], frame);
    } else {
        measure_angle(row, reaches_[i], frame);
    }
}

void TrialFinder::measure_angle(Row& row, const ReachPlan& reach, const servo::Frame& frame) const {
    const Vec3 arm = frame.fingers[reach.finger].p_WH - reach.from_W;
    if (arm.norm() < reach.distance) return;
    const Vec3 way = reach.to_W - reach.from_W;
    row.reach_time = row.end;
    row.hand_angle = angle_about(reach.axis_W, way, arm);
    const Vec3 shown = servo::displayed_handle(frame, reach.finger).p - reach.from_W;
    row.shown_angle = angle_about(reach.axis_W, way, shown);
}

/// Extents are measured from where the handle set out, since a finger that holds something is not
/// at the hand's middle. The wanted extent is what is then left of the way from region to region.
void TrialFinder::measure_extent(Row& row, const ReachPlan& reach,
                                 const servo::Frame& frame) const {
    const servo::FingerFrame& finger = frame.fingers[reach.finger];
    const Vec3 shown_W = servo::displayed_handle(frame, reach.finger).p;
    if (!row.hand_start_W) {
        row.hand_start_W = finger.p_WH;
        row.shown_start_W = shown_W;
    }
    const Vec3 way = reach.to_W - reach.from_W;
    const Vec3 along = way.normalized();
    if (!row.stroke.add(finger.v_WH.dot(along))) return;
    row.reach_time = row.end;
    row.hand_extent = (finger.p_WH - *row.hand_start_W).dot(along);
    row.shown_extent = (shown_W - row.shown_start_W).dot(along);
    row.wanted_extent = way.norm();
}

Table TrialFinder::table(const recording::SessionInfo& info) const {
    Table table;
    table.columns = kSessionColumns;
    const size_t listed = column(list_, "reach_finger");
    for (size_t k = 0; k < listed; ++k)
        table.columns.push_back({list_[0][k], listed_as(list_[0][k])});
    table.columns.insert(table.columns.end(), kMeasureColumns.begin(), kMeasureColumns.end());
    for (const Row& r : rows_) {
        std::vector<Table::Cell> row{r.start, r.end, info.title, info.participant.id, 1.0};
        const auto i = static_cast<size_t>(r.trial);
        for (size_t k = 0; k < listed; ++k) {
            const bool known = i < list_.size() && k < list_[i].size();
            // a procedure's share is only known once the trial is done
            if (known && list_[0][k] == "share" && list_[i][k].empty()) {
                row.emplace_back(r.share);
            } else {
                row.push_back(cell(known ? list_[i][k] : ""));
            }
        }
        const auto outcome = static_cast<size_t>(r.outcome);
        row.emplace_back(static_cast<double>(r.attempt));
        row.emplace_back(r.outcome >= 0 && outcome < info.outcomes.size()
                             ? info.outcomes[outcome]
                             : std::string(kInterrupted));
        row.insert(row.end(), {r.peak_grip, r.peak_force, r.reach_time - r.start,
                               r.hand_angle * kDegrees, r.shown_angle * kDegrees,
                               r.hand_extent * 1e3, r.shown_extent * 1e3, r.wanted_extent * 1e3});
        table.rows.push_back(row);
    }
    return table;
}

std::vector<Table::Column> trial_columns() {
    std::vector<Table::Column> out = kSessionColumns;
    for (const auto* more : {&recording::kTrialListColumns, &kMeasureColumns})
        out.insert(out.end(), more->begin(), more->end());
    out.insert(out.end(), recording::kMovedByColumns.begin(), recording::kMovedByColumns.end());
    return out;
}

void number_session(Table& own, const recording::SessionFolder& folder) {
    if (!is_there(folder.file(kBefore))) return;
    const CsvFile before(folder.file(kBefore));
    double last = 1;
    for (size_t i = 0; i < before.rows(); ++i)
        last = std::fmax(last, before.number(i, "session_num"));
    const auto number = static_cast<size_t>(
        std::find_if(own.columns.begin(), own.columns.end(),
                     [](const Table::Column& c) { return c.name == "session_num"; }) -
        own.columns.begin());
    for (std::vector<Table::Cell>& row : own.rows) row.at(number) = last + 1;
}

Table with_earlier(const Table& own, const recording::SessionFolder& folder) {
    if (!is_there(folder.file(kBefore))) return own;
    const auto before = read_csv(folder.file(kBefore));
    const size_t outcome = column(before, "outcome");
    const size_t number = column(before, "session_num");
    if (outcome == before[0].size() || number == before[0].size()) {
        throw Error({folder.file(kBefore), 1}, "", "has no columns 'outcome' and 'session_num'",
                    "Put the trials.csv of the session that this one goes on with in its place.");
    }
    Table table{own.columns, {}};
    // an earlier version's table may lack a column, or have it in another place
    std::vector<size_t> places;
    for (const Table::Column& c : own.columns) places.push_back(column(before, c.name));
    for (size_t i = 1; i < before.size(); ++i) {
        if (before[i].size() != before[0].size()) continue;
        if (before[i][outcome] == kInterrupted) continue;  // done again here
        std::vector<Table::Cell>& row = table.rows.emplace_back();
        for (const size_t place : places)
            row.push_back(cell(place < before[i].size() ? before[i][place] : ""));
    }
    table.rows.insert(table.rows.end(), own.rows.begin(), own.rows.end());
    return table;
}

}  // namespace dihaptic::analysis
