#include "task/procedures/posterior.h"

#include <numeric>

namespace dihaptic::task {

void normalise(std::vector<double>& probabilities) {
    const double sum = std::accumulate(probabilities.begin(), probabilities.end(), 0.0);
    for (double& p : probabilities) p /= sum;
}

double mean(std::span<const double> values, std::span<const double> probabilities) {
    return std::inner_product(values.begin(), values.end(), probabilities.begin(), 0.0);
}

double quantile(std::span<const double> values, std::span<const double> probabilities,
                double share) {
    double below = 0;
    for (size_t i = 0; i < values.size(); ++i) {
        const double here = below + probabilities[i];
        if (here >= share && probabilities[i] > 0) {
            if (i == 0) return values[0];
            return values[i - 1] + (values[i] - values[i - 1]) * (share - below) / probabilities[i];
        }
        below = here;
    }
    return values.back();
}

}  // namespace dihaptic::task
