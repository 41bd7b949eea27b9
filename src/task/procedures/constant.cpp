#include "task/procedures/constant.h"

#include <algorithm>
#include <cmath>

#include "base/diagnostics.h"

namespace dihaptic::task {

Constant::Constant(const std::vector<double>& levels, int trials, Random& random) {
    std::vector<double> round = levels;
    std::sort(round.begin(), round.end());
    const bool numbers =
        std::all_of(round.begin(), round.end(), [](double level) { return std::isfinite(level); });
    if (round.empty() || !numbers || std::adjacent_find(round.begin(), round.end()) != round.end())
        throw Error({}, "levels", "are not a list of different numbers",
                    "list each level once, e.g. [0.2, 0.4, 0.6]");
    if (trials < 1) throw Error({}, "trials", "is below 1", "give the number of trials");
    while (levels_.size() < static_cast<size_t>(trials)) {
        for (size_t i = round.size(); i > 1; --i) {
            const auto j = static_cast<size_t>(random.uniform(0, static_cast<double>(i)));
            std::swap(round[i - 1], round[std::min(j, i - 1)]);
        }
        levels_.insert(levels_.end(), round.begin(), round.end());
    }
    levels_.resize(static_cast<size_t>(trials));
}

}  // namespace dihaptic::task
