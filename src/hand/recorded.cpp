#include "hand/recorded.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

namespace dihaptic::hand {
namespace {

/// The grasp phase extends by this much beyond both ends of the quiet stretch, so that it includes
/// closing and opening.
constexpr double kAround = 0.4;  // [s]

}  // namespace

RecordedDriver::RecordedDriver(Path path, const GraspSite& site, const Vec3& shift,
                               const std::vector<std::string>& fingers)
    : path_(std::move(path)), shift_(shift) {
    for (const std::string& finger : fingers) {
        const auto found = std::find(path_.fingers.begin(), path_.fingers.end(), finger);
        if (found == path_.fingers.end()) {
            throw Error(fmt::format("the movement has no finger '{}'", finger),
                        fmt::format("It has {}: give these names to the scene's fingers.",
                                    fmt::join(path_.fingers, ", ")));
        }
        column_.push_back(static_cast<size_t>(found - path_.fingers.begin()));
    }
    const double grasp = std::max(0.0, site.start - kAround);
    const double leave = std::min(path_.duration(), site.end + kAround);
    phases_ = {{"reach", 0, grasp}, {"grasp", grasp, leave}, {"return", leave, path_.duration()}};
}

FingerTarget RecordedDriver::do_target(int finger, double t) const noexcept {
    const std::vector<Vec3>& p = path_.p_WH[column_[static_cast<size_t>(finger)]];
    const double at = std::clamp(t * Path::kRate, 0.0, static_cast<double>(p.size() - 2));
    const auto i = static_cast<size_t>(at);
    const Vec3 step = p[i + 1] - p[i];
    const bool inside = t > 0 && t < path_.duration();
    return {p[i] + (at - static_cast<double>(i)) * step + shift_,
            inside ? Vec3(step * Path::kRate) : Vec3::Zero()};
}

}  // namespace dihaptic::hand
