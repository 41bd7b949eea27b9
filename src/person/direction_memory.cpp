#include "person/direction_memory.h"

#include <algorithm>
#include <cmath>

namespace dihaptic::person {
namespace {

constexpr double kSameDirection = 0.09;  // directions closer than this count as the same [rad]

double angle_between(const Vec3& a, const Vec3& b) noexcept {
    return std::atan2(a.cross(b).norm(), a.dot(b));
}

}  // namespace

Vec3 DirectionMemory::added_to(Vec3 sum, const Vec3& d) const noexcept {
    for (size_t i = 0; i < count_; ++i) {
        const double angle = angle_between(d, taught_[i].d);
        // the same target, whose direction is judged with noise
        const double a = angle < kSameDirection ? 0 : angle / width_;
        sum += std::exp(-a * a / 2) * taught_[i].x;
    }
    return sum;
}

void DirectionMemory::learn(const Vec3& d, const Vec3& error) noexcept {
    size_t nearest = count_;
    double least = 4;
    for (size_t i = 0; i < count_; ++i) {
        taught_[i].x *= rate_.retention;
        const double a = angle_between(d, taught_[i].d);
        if (a < least) {
            least = a;
            nearest = i;
        }
    }
    if (least > kSameDirection && count_ < kMost) {
        nearest = count_++;
        taught_[nearest] = {d, Vec3::Zero()};
    }
    taught_[nearest].x += rate_.learning * error;
}

}  // namespace dihaptic::person
