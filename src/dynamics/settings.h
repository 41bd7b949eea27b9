// The settings of dynamics that an experiment may choose.
#pragma once

#include <array>

#include "base/field.h"
#include "contact/solver_settings.h"

namespace dihaptic::dynamics {

using contact::Solver;

struct Settings {
    Solver solver = Solver::newton;
    int every = 1;            ///< number of the servo's ticks per step of the world
    int iterations = 200;     ///< limit of iterations in a step, for sequential_impulse
    double tolerance = 1e-7;  ///< sequential_impulse ends when an iteration changes no contact's
                              ///< velocity by more [m/s]
    int friction_directions = 8;  ///< of the friction polygon of stewart_trinkle
    contact::DirectionFrame friction_frame =
        contact::DirectionFrame::sliding;  ///< placement: along sliding, or fixed
    bool warm_start = true;                ///< start from the contact forces of the last step
    double penetration_recovery =
        0.2;               ///< share of a penetration that one step removes (Bullet's erp2)
    bool sleeping = true;  ///< leave objects that are at rest and untouched out of the step
    int max_contacts = 0;  ///< contact points to reserve memory for; 0: by the number of bodies

    template <class Visitor>
    void visit(Visitor& v) {
        v("solver", solver);
        v("every", every, Field::number().at_least(1).at_most(100));
        v("iterations", iterations, Field::number().at_least(1).at_most(100000));
        v("tolerance", tolerance, Field::of(Quantity::speed).within(0, 1));
        v("friction_directions", friction_directions,
          Field::number().at_least(4).at_most(contact::kMostDirections));
        v("friction_frame", friction_frame);
        v("warm_start", warm_start);
        v("penetration_recovery", penetration_recovery, Field::number().at_least(0).at_most(1));
        v("sleeping", sleeping);
        v("max_contacts", max_contacts, Field::number().within(0, 100000));
    }
};

}  // namespace dihaptic::dynamics
