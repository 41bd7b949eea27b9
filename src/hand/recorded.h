// A driver that makes the hand follow a recorded and repaired movement.
#pragma once

#include "hand/driver.h"
#include "hand/grasp_site.h"

namespace dihaptic::hand {

class RecordedDriver final : public Driver {
  public:
    /// Adds `shift` to every position [m]. `fingers` are the fingers of the scene, in order. The
    /// phases are reach, grasp and return. Throws Error if one of the fingers is missing from the
    /// movement.
    RecordedDriver(Path path, const GraspSite& site, const Vec3& shift,
                   const std::vector<std::string>& fingers);

    double duration() const override { return path_.duration(); }
    const std::vector<Phase>& phases() const override { return phases_; }

  private:
    FingerTarget do_target(int finger, double t) const noexcept override;

    Path path_;
    Vec3 shift_;
    std::vector<size_t> column_;  // for each finger, its column in the path
    std::vector<Phase> phases_;
};

}  // namespace dihaptic::hand
