// What a person retains from one session to the next.
//
// Overnight, the fast process of adaptation is forgotten, and the slow process keeps its state:
// after 24 hours, people retained as much of a force field as the slow process of the model had
// learned in training (Joiner and Smith 2008). It is an assumption that rotations follow the same
// rule, and that gains and known weights stay unchanged.
#pragma once

#include <string>
#include <vector>

#include "person/force_memory.h"
#include "person/gain_memory.h"
#include "person/grip_memory.h"
#include "person/rotation_memory.h"

namespace dihaptic::person {

/// What a person has learned from the movements in a state of the task.
struct StateMemory {
    RotationMemory rotation;
    GainMemory gain;
    ForceMemory force;
};

struct Learned {
    /// Learned in one task state, and recalled in the state of the same name.
    struct InState {
        std::string state;
        StateMemory memory;
    };
    /// Learned about one object, and recalled for a body that has the same name and looks equally
    /// heavy.
    struct OfBody {
        std::string body;
        double looks = 0;  ///< weight that the object's appearance suggests [N]
        GripMemory memory;
    };
    std::vector<InState> states;
    std::vector<OfBody> bodies;
};

}  // namespace dihaptic::person
