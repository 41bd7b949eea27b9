// Term describes a quantity of the Frame, in one place: the visit() that lists it. The quantity has
// this name in the schema of the log, in session.nwb, in docs/quantities.md and in the window's
// plots.
#pragma once

namespace dihaptic::frame {

struct Term {
    const char* name;
    const char* unit;     ///< "1": a pure number
    const char* frame;    ///< of its components: W or D (docs/conventions.md); "": it has none
    const char* meaning;  ///< one sentence
};

}  // namespace dihaptic::frame
