// Which levels a sigmoid (model/psychometric.h) has a value at.
#pragma once

#include "model/psychometric.h"

namespace dihaptic::model {

/// `weibull` has none at 0 or below; the others take any.
constexpr bool takes(Sigmoid sigmoid, double level) {
    return sigmoid != Sigmoid::weibull || level > 0;
}

}  // namespace dihaptic::model
