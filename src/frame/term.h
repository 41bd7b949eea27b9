// Term describes a quantity of the Frame in a single place, the visit() that lists the quantity.
// The log's schema, session.nwb, docs/quantities.md and the plots in the window all use its name.
#pragma once

namespace dihaptic::frame {

struct Term {
    const char* name;
    const char* unit;     ///< unit; "1" for a dimensionless number
    const char* frame;    ///< frame in which the components are expressed: W or D
                          ///< (docs/conventions.md); "" if none
    const char* meaning;  ///< description in one sentence
};

}  // namespace dihaptic::frame
