#include "person/rotation_memory.h"

#include <algorithm>
#include <cmath>

namespace dihaptic::person {
namespace {

constexpr double kSameDirection = 0.09;  // nearer directions count as one [rad]

double angle_between(const Vec3& a, const Vec3& b) noexcept {
    return std::atan2(a.cross(b).norm(), a.dot(b));
}

}  // namespace

Vec3 RotationMemory::expected(const Vec3& d) const noexcept {
    Vec3 out = fast_;
    for (size_t i = 0; i < count_; ++i) {
        double a = angle_between(d, taught_[i].d) / width_;
        // the same target, whose direction is judged with noise
        if (a * width_ < kSameDirection) a = 0;
        out += std::exp(-a * a / 2) * taught_[i].slow;
    }
    return out;
}

void RotationMemory::learn(const Vec3& d, const Vec3& error) noexcept {
    fast_ = rates_.fast.retention * fast_ + rates_.fast.learning * error;
    size_t nearest = count_;
    double least = 4;
    for (size_t i = 0; i < count_; ++i) {
        taught_[i].slow *= rates_.slow.retention;
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
    taught_[nearest].slow += rates_.slow.learning * error;
}

}  // namespace dihaptic::person
