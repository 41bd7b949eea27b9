// The part of a session's page that shows each lift: grip and load force over time, aligned at
// lift-off, by condition and perturbation.
#pragma once

#include "analysis/report/page.h"
#include "analysis/report/session_data.h"
#include "frame/frame.h"

namespace dihaptic::analysis {

class LiftCurves {
  public:
    /// Shows the complete lifts in lifts.csv. `tick`: tick of the session [s].
    LiftCurves(const SessionData& session, double tick);

    /// Call for each frame of the log, in order.
    void see(const frame::Frame& frame);
    /// Adds a chart for each condition and perturbation; none if there were no lifts.
    void add_to(Page& page, const std::string& origin) const;

    static constexpr double kBefore = 0.6;  ///< time drawn before lift-off [s]
    static constexpr double kAfter = 1.0;   ///< time drawn after lift-off [s]
    static constexpr double kStep = 0.01;   ///< between points [s]

  private:
    static constexpr size_t kPoints = 161;
    struct Lift {
        std::string condition;
        int trial = 0;
        double lift_off = 0;  // [s]
        std::vector<double> grip;
        std::vector<double> load;

        double next() const {
            return lift_off - kBefore + kStep * static_cast<double>(grip.size());
        }
    };
    Chart chart_of(const std::string& condition, const std::string& origin) const;

    double tick_;
    std::vector<Lift> lifts_;  // in the order of their lift-offs
    size_t first_ = 0;         // all earlier lifts have been read
};

}  // namespace dihaptic::analysis
