#include "analysis/report/reach_paths.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "base/svg.h"
#include "task/file/task.h"
#include "task/plan/measures.h"
#include "task/plan/reach_plan.h"

namespace dihaptic::analysis {
namespace {

constexpr size_t kMostPanels = 16;
constexpr int kPanelsInRow = 4;
constexpr double kPanel = 230;     // width and height [px]
constexpr double kTitle = 24;      // height above a panel [px]
constexpr double kUnit = 150;      // length of the line from start to target [px]
constexpr double kStart = 45;      // height of the start above the panel's lower edge [px]
constexpr int64_t kEach = 5;       // ticks between points of a path
constexpr double kFarthest = 1.5;  // largest distance drawn, from the start, over the line's length

/// The colours of the kinds of trials, in the order of enum_names(rows::TrialKind).
constexpr std::array kKindColours{"#999999", "#555555", "#d55e00", "#000000",
                                  "#0072b2", "#cc79a7", "#009e73"};
static_assert(kKindColours.size() == enum_names(rows::TrialKind{}).size());

const char* colour_of(rows::TrialKind kind) {
    return kKindColours[static_cast<size_t>(kind)];
}

std::string circle(double x, double y, double radius) {
    return fmt::format("M {:.1f} {:.1f} a {r} {r} 0 1 0 {d} 0 a {r} {r} 0 1 0 -{d} 0", x - radius,
                       y, fmt::arg("r", radius), fmt::arg("d", 2 * radius));
}

}  // namespace

ReachPaths::ReachPaths(const SessionData& session, const recording::LogHead& head) {
    find_lines(session, head);
    trials_.resize(lines_.size());
    for (const rows::TrialRow& row : session.trials) {
        const rows::AskedRow& asked = row.asked;
        if (asked.trial < 1 || static_cast<size_t>(asked.trial) > trials_.size()) continue;
        trials_[static_cast<size_t>(asked.trial) - 1] = {
            (asked.round.empty() ? "" : asked.round + ", ") + asked.block, asked.kind};
    }
}

void ReachPaths::find_lines(const SessionData& session, const recording::LogHead& head) {
    const std::string list = session.folder.file("trial-list.csv");
    const auto finger_of = [&](const std::string& name) {
        const auto found = std::find(head.fingers.begin(), head.fingers.end(), name);
        finger_ = static_cast<size_t>(found - head.fingers.begin());
        return found != head.fingers.end();
    };
    const auto add = [&](const task::MovementPlan& plan) {
        lines_.push_back(
            {plan.from_W, plan.along_W(), plan.left_W(), (plan.to_W - plan.from_W).norm()});
    };
    if (session.task.reach) {
        for (const task::ReachPlan& reach : task::read_reaches(list)) {
            if (lines_.empty() && !finger_of(reach.finger)) return;
            task::MovementPlan plan;
            plan.from_W = reach.from_W;
            plan.to_W = reach.to_W;
            plan.axis_W = reach.axis_W;
            add(plan);
            phases_ = reach.phase_numbers();
        }
    } else if (session.task.movement && !head.fingers.empty()) {
        const task::Movement movement = task::movement_of(session.task, head.fingers.front());
        if (!finger_of(movement.of)) return;
        for (size_t i = 0; i < head.phases.size(); ++i) {
            const auto& during = movement.during;
            if (std::find(during.begin(), during.end(), head.phases[i].name) != during.end())
                phases_.push_back(static_cast<int>(i));
        }
        for (const task::MovementPlan& plan : task::read_movements(list)) add(plan);
    }
}

void ReachPaths::see(const frame::Frame& frame) {
    const auto trial = static_cast<size_t>(frame.trial) - 1;
    if (frame.trial < 1 || trial >= lines_.size() ||
        std::find(phases_.begin(), phases_.end(), frame.phase) == phases_.end())
        return;
    const bool same = !paths_.empty() && paths_.back().trial == frame.trial &&
                      paths_.back().attempt == frame.task.attempt;
    if (!same) paths_.push_back({frame.trial, frame.task.attempt, {}});
    if (same && frame.sequence < next_) return;
    next_ = frame.sequence + kEach;
    const Line& line = lines_[trial];
    const Vec3 arm = (frame.fingers[finger_].p_WH - line.from_W) / line.length;
    const Point point{arm.dot(line.along_W), arm.dot(line.left_W)};
    if (std::isfinite(point.along) && std::isfinite(point.left))
        paths_.back().points.push_back(point);
}

std::vector<ReachPaths::Panel> ReachPaths::panels() const {
    std::vector<Panel> out;
    for (const Path& path : paths_) {
        const std::string& block = trials_[static_cast<size_t>(path.trial) - 1].block;
        const auto found = std::find_if(out.begin(), out.end(),
                                        [&](const Panel& panel) { return panel.title == block; });
        (found == out.end() ? out.emplace_back(Panel{block, {}}) : *found).paths.push_back(&path);
    }
    return out;
}

void ReachPaths::add_to(Page& page, const std::string& origin) const {
    const std::vector<Panel> all = panels();
    if (all.empty()) return;
    const size_t drawn = std::min(all.size(), kMostPanels);
    const auto rows = static_cast<double>((drawn + kPanelsInRow - 1) / kPanelsInRow);
    Svg svg(kPanelsInRow * kPanel, rows * (kPanel + kTitle));
    for (size_t i = 0; i < drawn; ++i) {
        const double left = kPanel * static_cast<double>(i % kPanelsInRow);
        const double top = (kPanel + kTitle) * static_cast<double>(i / kPanelsInRow);
        const double x0 = left + kPanel / 2;
        const double y0 = top + kTitle + kPanel - kStart;
        svg.text(x0, top + 16, fmt::format("{} ({})", all[i].title, all[i].paths.size()), "middle",
                 "font-size=\"12\"");
        svg.path(circle(x0, y0, 4), "#999999", 1);
        svg.path(circle(x0, y0 - kUnit, 6), "#999999", 1);
        for (const Path* path : all[i].paths) {
            std::string d;
            for (const Point& p : path->points) {
                if (std::hypot(p.along, p.left) > kFarthest ||
                    std::abs(p.left) * kUnit > kPanel / 2)
                    continue;
                d += fmt::format("{}{:.1f} {:.1f}", d.empty() ? "M" : " L", x0 - kUnit * p.left,
                                 y0 - kUnit * p.along);
            }
            const char* colour = colour_of(trials_[static_cast<size_t>(path->trial) - 1].kind);
            if (!d.empty()) svg.path(d, colour, 1, "none", "stroke-opacity=\"0.5\"");
        }
    }
    page.heading("Each reach");
    page.picture(
        svg.take(),
        fmt::format("Paths of the hand in each block{}, turned so that each start is below and its "
                    "target above; left is to the left, seen from the tip of the angles' axis. In "
                    "brackets: attempts. Grey: practice and baseline; orange: perturbed; black: "
                    "catch; blue: visual clamps; pink: channels; green: washout. {}",
                    all.size() > drawn ? fmt::format(" (the first {})", drawn) : "", origin));
}

}  // namespace dihaptic::analysis
