// What a person knows of objects, from seeing them and from the lifts before.
#pragma once

#include "base/geometry.h"
#include "model/adaptation.h"
#include "model/gravity.h"
#include "person/traits.h"

namespace dihaptic::person {

using model::kGravity;

struct GripMemory {
    double weight = 1;      ///< that is expected [N]
    double friction = 0.5;  ///< of fingers on it, that is expected
    /// Mass beyond the weight's, by world axis: learned from carrying it along that axis [kg].
    Vec3 more_mass = Vec3::Zero();

    /// Force that moving it takes, beyond carrying its weight [N].
    Vec3 inertial(const Vec3& acceleration_W) const noexcept {
        return (Vec3::Constant(weight / kGravity) + more_mass).cwiseProduct(acceleration_W);
    }
    /// After a lift that felt so heavy [N].
    void lifted(double felt, double learning) noexcept { weight += learning * (felt - weight); }
    /// After carrying it along `u`, a unit vector, when that took `felt` kg: e is what was felt
    /// beyond what was expected, and each axis learns its part of it.
    void carried(const Vec3& u, double felt, const model::SingleRate& rate) noexcept {
        const Vec3 part = u.cwiseProduct(u);
        const double error = felt - weight / kGravity - part.dot(more_mass);
        for (int k = 0; k < 3; ++k)
            more_mass[k] += part[k] * (model::next(rate, more_mass[k], error) - more_mass[k]);
    }
};

}  // namespace dihaptic::person
