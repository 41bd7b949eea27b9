// Adaptation to displays that scale movements, by the single-rate model (model/adaptation.h). A
// person expects a movement in direction d (unit) to be shown longer by the factor exp(g(d)),
//
//     g(d) = sum over k of d_k^2 g_k                        k: the world's axes
//
// which for small g_k is the logarithm of |S d| for a scaling S = diag(exp(g_k)). A movement that
// was shown to go too far by the error e (a logarithm) changes the gains of the axes along which it
// went, so that g in that direction changes by B e:
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
    /// Learns from a completed movement. `error`: ln(length shown / length wanted).
    void learn(const Vec3& d, double error) noexcept {
        const Vec3 share = d.cwiseAbs2() / d.cwiseAbs2().squaredNorm();
        gain_ = rate_.retention * gain_ + rate_.learning * error * share;
    }

  private:
    model::SingleRate rate_;
    Vec3 gain_ = Vec3::Zero();  // g_k
};

}  // namespace dihaptic::person
