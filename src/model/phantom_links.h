// The link lengths of a PHANToM Premium.
#pragma once

#include "base/field.h"

namespace dihaptic::model {

struct PhantomLinks {
    double thigh = 0.14;  ///< l1 [m]
    double shin = 0.14;   ///< l2 [m]

    template <class Visitor>
    void visit(Visitor& v) {
        v("thigh", thigh, Field::length().within(0.05, 1).says("Length of the arm's first link."));
        v("shin", shin, Field::length().within(0.05, 1).says("Length of the arm's second link."));
    }
    bool operator==(const PhantomLinks&) const = default;
};

}  // namespace dihaptic::model
