#include "analysis/savitzky_golay.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

namespace dihaptic::analysis {

std::vector<double> savitzky_golay(std::span<const double> signal, double tick, double window,
                                   int order) {
    constexpr Eigen::Index kCubic = 4;
    const Eigen::Index half =
        std::max<Eigen::Index>(2, static_cast<Eigen::Index>(std::round(window / tick / 2)));
    const Eigen::Index size = 2 * half + 1;
    const auto count = static_cast<Eigen::Index>(signal.size());
    std::vector<double> out(signal.size(), 0);
    if (count < size) return out;

    // columns: powers of the position in the window, which ranges from -1 to 1
    Eigen::MatrixXd powers(size, kCubic);
    for (Eigen::Index i = 0; i < size; ++i) {
        const double u = static_cast<double>(i - half) / static_cast<double>(half);
        for (Eigen::Index p = 0; p < kCubic; ++p) powers(i, p) = std::pow(u, p);
    }
    // row p: weights of the samples in the cubic's p-th coefficient
    const Eigen::MatrixXd coefficients =
        (powers.transpose() * powers).ldlt().solve(powers.transpose());
    const double scale = 1 / (static_cast<double>(half) * tick);
    const auto weights = [&](Eigen::Index at) {
        const double u = static_cast<double>(at - half) / static_cast<double>(half);
        Eigen::RowVectorXd row = Eigen::RowVectorXd::Zero(size);
        for (Eigen::Index p = order; p < kCubic; ++p) {
            double factor = std::pow(scale, order);
            for (Eigen::Index q = p; q > p - order; --q) factor *= static_cast<double>(q);
            row += factor * std::pow(u, p - order) * coefficients.row(p);
        }
        return row;
    };
    const Eigen::Map<const Eigen::VectorXd> y(signal.data(), count);
    const Eigen::RowVectorXd middle = weights(half);
    for (Eigen::Index i = 0; i < count; ++i) {
        const Eigen::Index first = std::clamp<Eigen::Index>(i - half, 0, count - size);
        const auto part = y.segment(first, size);
        const bool inside = i - half == first;
        out[static_cast<size_t>(i)] =
            inside ? middle.dot(part.transpose()) : weights(i - first).dot(part.transpose());
    }
    return out;
}

}  // namespace dihaptic::analysis
