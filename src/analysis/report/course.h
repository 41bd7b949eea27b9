// The part of a session's page that shows forces and height over time: in all of a short session,
// or in the first complete lift of a long one.
#pragma once

#include <optional>

#include "analysis/report/page.h"
#include "analysis/report/session_data.h"
#include "recording/raw_log.h"

namespace dihaptic::analysis {

class CourseCharts {
  public:
    /// `session` must outlive the object.
    CourseCharts(const SessionData& session, const recording::LogHead& head);

    /// Call for each frame of the log, in order.
    void see(const frame::Frame& frame);
    /// Adds the charts; none for a long session without a complete lift.
    void add_to(Page& page, const std::string& origin);

  private:
    struct Excerpt {
        double from = 0;  // [s]
        double to = 0;
        std::string what = "The session";
    };
    static std::optional<Excerpt> excerpt_of(const SessionData& session,
                                             const recording::LogHead& head);

    const SessionData& session_;
    std::optional<Excerpt> excerpt_;
    bool two_;                    // at least two fingers: there is a grip
    std::ptrdiff_t object_ = -1;  // among the bodies; -1: none
    int phase_ = -1;
    Series grip_, load_, height_;
    std::vector<Series> sent_;  // force sent, by finger
    std::vector<Mark> marks_;   // beginnings of phases
};

}  // namespace dihaptic::analysis
