#include "contact/stewart_trinkle/lemke.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace dihaptic::contact {
namespace {

/// Column entries below this value count as zero, in problems whose diagonals are about 1.
constexpr double kLeastPivot = 1e-10;
constexpr int kPivotsPerVariable = 8;

/// Returns a patternless value between 0.5 and 1.5 that is the same on every machine.
double scattered(int attempt, int i) noexcept {
    auto x = (static_cast<uint64_t>(attempt) << 32) + static_cast<uint64_t>(i) + 1;
    x *= 0x9E3779B97F4A7C15u;
    x ^= x >> 29;
    x *= 0xBF58476D1CE4E5B9u;
    x ^= x >> 32;
    return 0.5 + static_cast<double>(x >> 11) * 0x1.0p-53;
}

}  // namespace

void Lemke::reserve(int variables) {
    capacity_ = variables;
    const auto n = static_cast<size_t>(variables);
    M_ = std::make_unique_for_overwrite<double[]>(n * n);
    tableau_ = std::make_unique_for_overwrite<double[]>(n * (2 * n + 2));
    for (auto* v : {&q_, &z_, &w_, &right_}) v->resize(n);
    basis_.reserve(n);
    last_basis_.reserve(n);
}

void Lemke::start(int variables) noexcept {
    if (variables != n_) last_basis_.clear();
    n_ = variables;
    stride_ = 2 * static_cast<size_t>(variables) + 2;
    pivots_ = 0;
    std::fill_n(M_.get(), static_cast<size_t>(n_) * static_cast<size_t>(n_), 0.0);
    std::fill_n(q_.begin(), static_cast<size_t>(n_), 0.0);
}

bool Lemke::solve(int attempt, int64_t most_pivots) noexcept {
    const auto n = static_cast<size_t>(n_);
    const size_t z0 = 2 * n;
    const size_t right = 2 * n + 1;
    const int most =
        pivots_ + static_cast<int>(std::min<int64_t>(kPivotsPerVariable * n_, most_pivots));
    double least = 0;
    for (int i = 0; i < n_; ++i) {
        double* r = row(i);
        std::fill_n(r, stride_, 0.0);
        r[i] = 1;
        for (size_t j = 0; j < n; ++j) r[n + j] = -M(i, static_cast<int>(j));
        r[z0] = attempt == 0 ? -1 : -scattered(attempt, i);
        r[right] = q(i);
        least = std::min(least, q(i));
    }
    basis_.resize(n);
    for (int i = 0; i < n_; ++i) basis_[static_cast<size_t>(i)] = i;
    if (least >= 0) {
        read_solution();
        return true;
    }
    // z0 enters in the row that requires the largest value of z0
    int leaving = 0;
    for (int i = 1; i < n_; ++i) {
        if (lexicographically_less(i, -row(i)[z0], leaving, -row(leaving)[z0])) leaving = i;
    }
    int entering = static_cast<int>(z0);
    for (; pivots_ < most; ++pivots_) {
        const int left = basis_[static_cast<size_t>(leaving)];
        pivot(leaving, entering);
        if (left == static_cast<int>(z0)) {
            read_solution();
            return true;
        }
        entering = left < n_ ? left + n_ : left - n_;  // the complement
        leaving = leaving_row(entering);
        if (leaving < 0) return false;
    }
    return false;
}

bool Lemke::lexicographically_less(int i, double by_i, int j, double by_j) noexcept {
    const double* a = row(i);
    const double* b = row(j);
    const auto compare = [&](size_t column) {
        const double x = a[column] / by_i;
        const double y = b[column] / by_j;
        const double close = 1e-12 * (std::abs(x) + std::abs(y));
        return x < y - close ? -1 : x > y + close ? 1 : 0;
    };
    if (const int order = compare(stride_ - 1); order != 0) return order < 0;
    for (size_t column = 0; column < static_cast<size_t>(n_); ++column) {
        if (const int order = compare(column); order != 0) return order < 0;
    }
    return false;
}

int Lemke::leaving_row(int entering) noexcept {
    int best = -1;
    const int z0 = 2 * n_;
    for (int i = 0; i < n_; ++i) {
        const double by = row(i)[entering];
        if (by <= kLeastPivot) continue;
        if (best < 0 || lexicographically_less(i, by, best, row(best)[entering])) best = i;
    }
    if (best < 0) return best;
    // in a tie z0 leaves, since that ends the search
    const double ratio = row(best)[stride_ - 1] / row(best)[entering];
    for (int i = 0; i < n_; ++i) {
        const double by = row(i)[entering];
        if (basis_[static_cast<size_t>(i)] == z0 && by > kLeastPivot &&
            row(i)[stride_ - 1] / by <= ratio + 1e-14)
            return i;
    }
    return best;
}

void Lemke::pivot(int leaving, int entering) noexcept {
    double* r = row(leaving);
    const double by = 1 / r[entering];
    for (size_t j = 0; j < stride_; ++j) r[j] *= by;
    r[entering] = 1;
    for (int i = 0; i < n_; ++i) {
        if (i == leaving) continue;
        double* other = row(i);
        const double factor = other[entering];
        if (factor == 0) continue;
        for (size_t j = 0; j < stride_; ++j) other[j] -= factor * r[j];
        other[entering] = 0;
    }
    basis_[static_cast<size_t>(leaving)] = entering;
}

void Lemke::read_solution() noexcept {
    std::fill_n(z_.begin(), static_cast<size_t>(n_), 0.0);
    std::fill_n(w_.begin(), static_cast<size_t>(n_), 0.0);
    last_basis_.clear();
    for (int i = 0; i < n_; ++i) {
        const int column = basis_[static_cast<size_t>(i)];
        const double value = std::max(0.0, row(i)[stride_ - 1]);
        if (column < n_) {
            w_[static_cast<size_t>(column)] = value;
        } else if (column < 2 * n_) {
            z_[static_cast<size_t>(column - n_)] = value;
            last_basis_.push_back(column - n_);
        }
    }
    std::sort(last_basis_.begin(), last_basis_.end());
}

bool Lemke::try_last_basis() noexcept {
    const auto m = static_cast<int>(last_basis_.size());
    if (m == 0 || !solve_last_basis(m)) return false;
    double size = 0;
    for (int i = 0; i < n_; ++i) size = std::max(size, std::abs(q(i)));
    const double small = 1e-12 * size;
    for (int i = 0; i < m; ++i) {
        if (right_[static_cast<size_t>(i)] < -small) return false;
    }
    for (int i = 0; i < n_; ++i) {
        double sum = q(i);
        for (int j = 0; j < m; ++j)
            sum += M(i, last_basis_[static_cast<size_t>(j)]) * right_[static_cast<size_t>(j)];
        if (sum < -small) return false;
        w_[static_cast<size_t>(i)] = sum;
    }
    const auto n = static_cast<unsigned>(n_);  // never < 0, which not every compiler recognises
    std::fill(z_.begin(), z_.begin() + n, 0.0);
    for (int i = 0; i < m; ++i) {
        const auto variable = static_cast<size_t>(last_basis_[static_cast<size_t>(i)]);
        z_[variable] = std::max(0.0, right_[static_cast<size_t>(i)]);
        w_[variable] = 0;
    }
    return true;
}

/// Computes the values for the last basis, in right_. Uses Gaussian elimination in this object's
/// memory, because Eigen's factorisations would allocate. Returns false if the basis is singular.
bool Lemke::solve_last_basis(int m) noexcept {
    const auto at = [&](int i, int j) -> double& {
        return tableau_[static_cast<size_t>(i) * static_cast<size_t>(m) + static_cast<size_t>(j)];
    };
    for (int i = 0; i < m; ++i) {
        const int row_index = last_basis_[static_cast<size_t>(i)];
        for (int j = 0; j < m; ++j) at(i, j) = M(row_index, last_basis_[static_cast<size_t>(j)]);
        right_[static_cast<size_t>(i)] = -q(row_index);
    }
    for (int k = 0; k < m; ++k) {
        int best = k;
        for (int i = k + 1; i < m; ++i) {
            if (std::abs(at(i, k)) > std::abs(at(best, k))) best = i;
        }
        if (std::abs(at(best, k)) < kLeastPivot) return false;
        if (best != k) {
            std::swap_ranges(&at(k, 0), &at(k, 0) + m, &at(best, 0));
            std::swap(right_[static_cast<size_t>(k)], right_[static_cast<size_t>(best)]);
        }
        for (int i = k + 1; i < m; ++i) {
            const double factor = at(i, k) / at(k, k);
            if (factor == 0) continue;
            for (int j = k; j < m; ++j) at(i, j) -= factor * at(k, j);
            right_[static_cast<size_t>(i)] -= factor * right_[static_cast<size_t>(k)];
        }
    }
    for (int k = m; k-- > 0;) {
        double sum = right_[static_cast<size_t>(k)];
        for (int j = k + 1; j < m; ++j) sum -= at(k, j) * right_[static_cast<size_t>(j)];
        right_[static_cast<size_t>(k)] = sum / at(k, k);
    }
    return true;
}

}  // namespace dihaptic::contact
