// Adaptation to displays that scale movements, by the single-rate model (model/adaptation.h). A
// person expects the display to lengthen a movement along the unit vector d by the factor
// exp(g(d)), where
//
//     g(d) = sum over k of d_k^2 g_k                        k: the world's axes
//
// For small g_k, this is the logarithm of |S d| for a scaling S = diag(exp(g_k)). If the display
// showed a movement that went too far by the error e (a logarithm), the gains of the axes along
// which the movement went are changed so that g in that direction changes by B e:
//
//     g_k <- A g_k + B e d_k^2 / sum over j of d_j^4
#pragma once

#include <cmath>

#include "base/geometry.h"
#include "model/adaptation.h"

namespace dihaptic::person {

class GainMemory {
  public:
    explicit GainMemory(const model::SingleRate& rate) : rate_(rate) {}

    /// g(d).
    double expected(const Vec3& d) const noexcept { return d.cwiseAbs2().dot(gain_); }
    /// Updates the memory after a completed movement. `error`: ln(displayed length / intended
    /// length).
    void learn(const Vec3& d, double error) noexcept {
        const Vec3 share = d.cwiseAbs2() / d.cwiseAbs2().squaredNorm();
        gain_ = rate_.retention * gain_ + rate_.learning * error * share;
    }

  private:
    model::SingleRate rate_;
    Vec3 gain_ = Vec3::Zero();  // g_k
};

}  // namespace dihaptic::person
