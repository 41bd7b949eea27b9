// Specifies the trials that show how soon a hand corrects its movement, and the trials they are
// compared with.
#pragma once

#include "scene/scene.h"
#include "task/file/ref.h"

namespace dihaptic::task {

struct State;
struct Condition;

/// Corrections of a movement in trials in which something happens when the state `after` begins,
/// compared with matched trials in which nothing happens (analysis/corrections.h).
struct CorrectionSpec {
    Ref<scene::Finger> of;  ///< finger whose handle corrects; if empty, the scene's first finger
    Ref<State> after;       ///< state from whose beginning time is counted
    Vec3 axis = Vec3::UnitX();   ///< direction of the corrections; need not be a unit vector
    RefList<Condition> matched;  ///< conditions of the matched trials; if empty, trials of the same
                                 ///< condition without a perturbation
    Place place;

    template <class Visitor>
    void visit(Visitor& v) {
        v("of", of, says("Finger whose handle corrects; the scene's first finger if omitted."));
        v("after", after,
          Field::text().required().says("State at whose beginning something happens."));
        v("axis", axis,
          Field::number()
              .within(-1000, 1000)
              .says("Direction along which corrections are looked for; a vector of any length."));
        v("matched", matched,
          says("Conditions in which nothing happens; if omitted, the trials of the same condition "
               "without a perturbation."));
    }
};

}  // namespace dihaptic::task
