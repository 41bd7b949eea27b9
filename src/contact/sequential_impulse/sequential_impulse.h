// Sequential impulses: projected Gauss-Seidel sweeps on Coulomb's law, each over all normal
// impulses and then over all friction impulses (law.h). The sweeps do not aim for a particular
// residual: the state after the last sweep is the answer.
#pragma once

#include <algorithm>

#include "contact/newton/newton.h"
#include "contact/solver_settings.h"

namespace dihaptic::contact {

/// Sweeps until no contact's velocity changes by more than the tolerance, or until `most` sweeps
/// are done.
template <class System>
Outcome sequential_impulse(System& system, std::span<typename System::Vec> r,
                           const SweepSettings& settings, int most) noexcept {
    Outcome out;
    out.iterations = system.sweep(law::NormalThenFriction{}, r, std::min(most, settings.most),
                                  settings.tolerance);
    out.converged = true;
    return out;
}

}  // namespace dihaptic::contact
