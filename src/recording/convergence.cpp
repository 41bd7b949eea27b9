#include "recording/convergence.h"

#include <fmt/format.h>

#include "base/plural.h"

namespace dihaptic::recording {

std::string Convergence::describe() const {
    const std::string all = counted(ticks, "tick");
    std::string out =
        missed == 0
            ? fmt::format("the contact solver was within its tolerance of 1e-08 in all {}", all)
            : fmt::format(
                  "the contact solver missed its tolerance of 1e-08 in {} of {}, in at "
                  "most {} in a row",
                  missed, all, longest_run);
    // the residual is zero if no finger touched anything
    if (held_residual.value_or(0) > 0) {
        out += fmt::format("; its largest residual at touched objects was {:.1g}", *held_residual);
        if (missed > 0 && held_residual_time)
            out += fmt::format(", at {:.3f} s", *held_residual_time);
    }
    return out;
}

}  // namespace dihaptic::recording
