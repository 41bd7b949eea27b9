// A simulated person's knowledge of an object, from its appearance and from earlier lifts.
#pragma once

#include "base/geometry.h"
#include "model/adaptation.h"
#include "model/gravity.h"
#include "person/traits.h"

namespace dihaptic::person {

using model::kGravity;

struct GripMemory {
    double weight = 1;      ///< expected weight [N]
    double friction = 0.5;  ///< expected friction of fingers on the object
    /// Mass beyond that of the weight, by world axis, learned from carrying the object along that
    /// axis [kg].
    Vec3 more_mass = Vec3::Zero();

    /// Force required to move the object, beyond carrying its weight [N].
    Vec3 inertial(const Vec3& acceleration_W) const noexcept {
        return (Vec3::Constant(weight / kGravity) + more_mass).cwiseProduct(acceleration_W);
    }
    /// Learns from a lift; `felt`: the felt weight [N].
    void lifted(double felt, double learning) noexcept { weight += learning * (felt - weight); }
    /// Learns from carrying the object along the unit vector `u`; `felt`: the felt mass [kg]. Each
    /// axis learns its part of the error, which is felt minus expected mass.
    void carried(const Vec3& u, double felt, const model::SingleRate& rate) noexcept {
        const Vec3 part = u.cwiseProduct(u);
        const double error = felt - weight / kGravity - part.dot(more_mass);
        for (int k = 0; k < 3; ++k)
            more_mass[k] += part[k] * (model::next(rate, more_mass[k], error) - more_mass[k]);
    }
};

}  // namespace dihaptic::person
