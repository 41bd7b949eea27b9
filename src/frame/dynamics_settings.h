// The dynamics settings that an experiment can choose.
#pragma once

#include <array>

#include "base/field.h"
#include "contact/solver_settings.h"

namespace dihaptic::frame {

struct DynamicsSettings {
    contact::Solver solver = contact::Solver::newton;
    int every = 1;            ///< number of servo ticks per world step
    int iterations = 200;     ///< maximum number of iterations in a step, for sequential_impulse
    double tolerance = 1e-7;  ///< sequential_impulse ends when an iteration changes the velocity of
                              ///< every contact by no more than this [m/s]
    int friction_directions = 8;  ///< number of directions in stewart_trinkle's friction polygon
    contact::DirectionFrame friction_frame =
        contact::DirectionFrame::sliding;  ///< orientation: along the sliding direction, or fixed
    bool warm_start = true;  ///< whether to start from the contact forces of the last step
    double penetration_recovery =
        0.2;  ///< fraction of a penetration that is removed in one step (Bullet's erp2)
    bool sleeping = true;  ///< whether to leave untouched objects that are at rest out of the step
    int max_contacts = 0;  ///< number of contact points for which memory is reserved; 0: depends on
                           ///< the number of bodies

    template <class Visitor>
    void visit(Visitor& v) {
        v("solver", solver, says("Contact solver."));
        v("every", every,
          Field::number().at_least(1).at_most(100).says("Number of ticks per step of the world."));
        v("iterations", iterations,
          Field::number().at_least(1).at_most(100000).says(
              "Largest number of iterations in a step, for sequential_impulse."));
        v("tolerance", tolerance,
          Field::of(Quantity::speed)
              .within(0, 1)
              .says("Change of velocity below which sequential_impulse ends."));
        v("friction_directions", friction_directions,
          Field::number()
              .at_least(4)
              .at_most(contact::kMostDirections)
              .says("Directions of the friction polygon of stewart_trinkle."));
        v("friction_frame", friction_frame,
          says("Whether the first direction lies along each contact's friction or along its "
               "frame."));
        v("warm_start", warm_start,
          says("Whether a step starts from the last step's contact impulses."));
        v("penetration_recovery", penetration_recovery,
          Field::number().at_least(0).at_most(1).says(
              "Fraction of a penetration that one step removes."));
        v("sleeping", sleeping,
          says("Whether untouched objects at rest are left out of the step."));
        v("max_contacts", max_contacts,
          Field::number().within(0, 100000).says("Number of contact points with reserved memory; "
                                                 "0: by the number of bodies."));
    }
};

}  // namespace dihaptic::frame
