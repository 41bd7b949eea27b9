// Term describes a quantity of the Frame in a single place, the visit() that lists it. The log's
// schema, session.nwb, docs/quantities.md and the window's plots all use its name.
#pragma once

namespace dihaptic::frame {

struct Term {
    const char* name;
    const char* unit;     ///< "1": a pure number
    const char* frame;    ///< frame of its components: W or D (docs/conventions.md); "": none
    const char* meaning;  ///< one sentence
};

}  // namespace dihaptic::frame
