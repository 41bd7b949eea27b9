// What of a Frame is shown: the only place where drawing reads poses. Visual maps move what is seen
// away from what is felt.
#pragma once

#include "servo/displayed.h"

namespace dihaptic::view {

using servo::displayed_body;
using servo::displayed_handle;
using servo::displayed_proxy;

}  // namespace dihaptic::view
