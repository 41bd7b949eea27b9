// Describes which trials show how soon a hand corrects its movement, and against which others.
#pragma once

#include "scene/scene.h"
#include "task/file/ref.h"

namespace dihaptic::task {

struct State;
struct Condition;

/// Corrections of a movement in trials in which something happens when the state `after` begins,
/// against matched trials in which nothing does (analysis/corrections.h).
struct CorrectionSpec {
    Ref<scene::Finger> of;       ///< empty: the first
    Ref<State> after;            ///< time is counted from its beginning
    Vec3 axis = Vec3::UnitX();   ///< along which the hand corrects, of any length
    RefList<Condition> matched;  ///< empty: trials of the same condition without a perturbation
    Place place;

    template <class Visitor>
    void visit(Visitor& v) {
        v("of", of, says("Finger whose handle corrects; the scene's first finger if omitted."));
        v("after", after,
          Field::text().required().says("State at whose beginning something happens."));
        v("axis", axis,
          Field::number()
              .within(-1000, 1000)
              .says("Direction along which corrections are looked for, of any length."));
        v("matched", matched,
          says("Conditions in which nothing happens; if omitted, the trials of the same condition "
               "without a perturbation."));
    }
};

}  // namespace dihaptic::task
