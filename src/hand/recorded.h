// A hand that follows a recorded, repaired movement.
#pragma once

#include "hand/driver.h"
#include "hand/grasp_site.h"

namespace dihaptic::hand {

class RecordedDriver final : public Driver {
  public:
    /// `shift` is added to every position [m]; `fingers` are the scene's, in order. The phases are
    /// reach, grasp and return. Throws Error when the movement lacks one of the fingers.
    RecordedDriver(Path path, const GraspSite& site, const Vec3& shift,
                   const std::vector<std::string>& fingers);

    double duration() const override { return path_.duration(); }
    const std::vector<Phase>& phases() const override { return phases_; }

  private:
    FingerTarget do_target(int finger, double t) const noexcept override;

    Path path_;
    Vec3 shift_;
    std::vector<size_t> column_;  // column of the path, by finger
    std::vector<Phase> phases_;
};

}  // namespace dihaptic::hand
