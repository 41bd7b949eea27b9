// The contents of person.yaml: the traits of a session's simulated person and, in a task for two,
// those of the partner.
#pragma once

#include <optional>

#include "person/traits.h"

namespace dihaptic::session {

struct SeatedPeople {
    person::Traits person;
    std::optional<person::Traits> partner;

    template <class Visitor>
    void visit(Visitor& v) {
        person.visit(v);
        v("partner", partner);
    }
};

}  // namespace dihaptic::session
