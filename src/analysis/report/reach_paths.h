// The part of a session's page that shows each reach: the hand's paths seen along the axis of the
// angles, a panel for each block, turned so that all targets are above the start.
#pragma once

#include "analysis/report/page.h"
#include "analysis/report/session_data.h"
#include "recording/raw_log.h"

namespace dihaptic::analysis {

class ReachPaths {
  public:
    /// Shows the reaches measured by the task's `reach`, or else by its `movement`, if a finger
    /// makes it.
    ReachPaths(const SessionData& session, const recording::LogHead& head);

    /// Call for each frame of the log, in order.
    void see(const frame::Frame& frame);
    /// Adds a picture; nothing if the task has no reaches.
    void add_to(Page& page, const std::string& origin) const;

  private:
    /// The straight line of a trial, and the directions that are drawn upward and to the left.
    struct Line {
        Vec3 from_W, along_W, left_W;
        double length = 0;  // [m]
    };
    struct Point {
        double along, left;  // over the length of the line
    };
    struct Path {
        int trial = 0;
        int attempt = 0;
        std::vector<Point> points;
    };
    struct Panel {
        std::string title;
        std::vector<const Path*> paths;
    };
    void find_lines(const SessionData& session, const recording::LogHead& head);
    std::vector<Panel> panels() const;

    struct Shown {
        std::string block;
        rows::TrialKind kind = rows::TrialKind::baseline;
    };
    std::vector<Shown> trials_;  // by trial
    std::vector<Line> lines_;    // by trial
    std::vector<int> phases_;    // phases in which a reach is made
    size_t finger_ = 0;
    int64_t next_ = 0;  // tick of the next point
    std::vector<Path> paths_;
};

}  // namespace dihaptic::analysis
