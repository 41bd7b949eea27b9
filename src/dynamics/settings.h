// What an experiment may choose about dynamics.
#pragma once

#include <array>

#include "base/field.h"

namespace dihaptic::dynamics {

enum class Solver { sequential_impulse };
constexpr auto enum_names(Solver) {
    return std::array{"sequential_impulse"};
}

struct Settings {
    Solver solver = Solver::sequential_impulse;
    int every = 1;         ///< one step in so many ticks of the servo
    int iterations = 200;  ///< most iterations of a step
    double tolerance =
        1e-7;  ///< a step ends when an iteration changes no contact's velocity by more [m/s]
    bool warm_start = true;  ///< start from the last step's contact forces
    double penetration_recovery =
        0.2;               ///< share of a penetration that one step removes (Bullet's erp2)
    bool sleeping = true;  ///< objects at rest that nothing touches are left out of the step
    int max_contacts = 0;  ///< contact points to reserve memory for; 0: from the number of bodies

    template <class Visitor>
    void visit(Visitor& v) {
        v("solver", solver);
        v("every", every, Field::number().at_least(1).at_most(100));
        v("iterations", iterations, Field::number().at_least(1).at_most(100000));
        v("tolerance", tolerance, Field::of(Quantity::speed).at_least(0));
        v("warm_start", warm_start);
        v("penetration_recovery", penetration_recovery, Field::number().at_least(0).at_most(1));
        v("sleeping", sleeping);
        v("max_contacts", max_contacts, Field::number().at_least(0).at_most(1000000));
    }
};

}  // namespace dihaptic::dynamics
