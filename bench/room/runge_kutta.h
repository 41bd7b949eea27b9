// Integrates equations of motion independently of our dynamics, which are tested against the
// result.
#pragma once

namespace dihaptic::bench {

/// One step of Runge and Kutta's method of fourth order, over a time d [s]; rate(s) is the
/// derivative of a state s.
template <class State, class F>
State runge_kutta(const State& s, double d, const F& rate) {
    const State k1 = rate(s);
    const State k2 = rate(State(s + d / 2 * k1));
    const State k3 = rate(State(s + d / 2 * k2));
    const State k4 = rate(State(s + d * k3));
    return s + d / 6 * (k1 + 2 * k2 + 2 * k3 + k4);
}

}  // namespace dihaptic::bench
