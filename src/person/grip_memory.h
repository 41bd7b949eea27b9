// A simulated person's knowledge about an object, gained from its appearance and from earlier
// lifts.
#pragma once

#include "base/geometry.h"
#include "model/adaptation.h"
#include "model/gravity.h"
#include "person/traits.h"

namespace dihaptic::person {

using model::kGravity;

struct GripMemory {
    double weight = 1;      ///< expected weight [N]
    double friction = 0.5;  ///< expected friction between the fingers and the object
    /// Mass in addition to the one that causes the weight, for each world axis, learned from
    /// carrying the object along that axis [kg].
    Vec3 more_mass = Vec3::Zero();

    /// Force required to accelerate the object, in addition to the force that supports its weight
    /// [N].
    Vec3 inertial(const Vec3& acceleration_W) const noexcept {
        return (Vec3::Constant(weight / kGravity) + more_mass).cwiseProduct(acceleration_W);
    }
    /// Updates the memory after a lift. `felt`: the felt weight [N].
    void lifted(double felt, double learning) noexcept { weight += learning * (felt - weight); }
    /// Updates the memory after the object was carried along the unit vector `u`. `felt`: the felt
    /// mass [kg]. The error, i.e. the difference between felt and expected mass, is divided among
    /// the axes.
    void carried(const Vec3& u, double felt, const model::SingleRate& rate) noexcept {
        const Vec3 part = u.cwiseProduct(u);
        const double error = felt - weight / kGravity - part.dot(more_mass);
        for (int k = 0; k < 3; ++k)
            more_mass[k] += part[k] * (model::next(rate, more_mass[k], error) - more_mass[k]);
    }
};

}  // namespace dihaptic::person
