// HalfSpaces finds the point nearest to v that satisfies a set of constraints n_i . x >= b_i:
//
//     minimise |x - v|^2 / 2    subject to    n_i . x >= b_i
//
// using the optimality conditions x = v + sum l_i n_i, l_i >= 0, l_i (n_i . x - b_i) = 0 (Zilles
// and Salisbury 1995). In three dimensions, at most three constraints determine the solution. All
// sets of up to three constraints are therefore tried, the smallest first; this is exact, and the
// work is bounded.
#pragma once

#include <array>
#include <cmath>
#include <limits>

#include "base/geometry.h"

namespace dihaptic::haptics {

constexpr size_t kMostHalfSpaces = 6;

/// The indices of up to three half-spaces, in ascending order.
struct HalfSpaceSet {
    std::array<size_t, 3> index{};
    size_t size = 0;

    /// Whether all half-spaces of the set are among the first `count`.
    constexpr bool within(size_t count) const noexcept {
        return size == 0 || index[size - 1] < count;
    }
};
/// All possible sets, the smallest first.
constexpr auto kHalfSpaceSets = [] {
    std::array<HalfSpaceSet, 42> out{};
    size_t at = 1;  // the first set is empty
    for (size_t i = 0; i < kMostHalfSpaces; ++i) out[at++] = {{i}, 1};
    for (size_t i = 0; i < kMostHalfSpaces; ++i)
        for (size_t j = i + 1; j < kMostHalfSpaces; ++j) out[at++] = {{i, j}, 2};
    for (size_t i = 0; i < kMostHalfSpaces; ++i)
        for (size_t j = i + 1; j < kMostHalfSpaces; ++j)
            for (size_t k = j + 1; k < kMostHalfSpaces; ++k) out[at++] = {{i, j, k}, 3};
    return out;
}();

struct HalfSpaces {
    std::array<Vec3, kMostHalfSpaces> n;  // unit
    std::array<double, kMostHalfSpaces> b{};
    std::array<double, kMostHalfSpaces> multiplier{};  // l from the last call of nearest()
    size_t count = 0;

    void add(const Vec3& normal, double bound = 0) noexcept {
        n[count] = normal;
        b[count++] = bound;
    }

    /// Returns x and sets the multipliers. If no point satisfies all constraints, x is the point
    /// that violates them least.
    Vec3 nearest(const Vec3& v) noexcept {
        const double slack = 1e-13 + 1e-12 * v.norm();
        double least_miss = std::numeric_limits<double>::infinity();
        Vec3 best = v;
        multiplier.fill(0);
        for (const HalfSpaceSet& set : kHalfSpaceSets) {
            Vec3 l;
            Vec3 x = v;
            if (!set.within(count) || !meet(set, x, l)) continue;
            double miss = 0;
            for (size_t i = 0; i < count; ++i) miss = std::max(miss, b[i] - n[i].dot(x));
            if (miss >= least_miss) continue;
            least_miss = miss;
            best = x;
            multiplier.fill(0);
            for (size_t i = 0; i < set.size; ++i)
                multiplier[set.index[i]] = l[static_cast<Eigen::Index>(i)];
            if (miss <= slack) break;
        }
        return best;
    }

  private:
    /// Moves x to the nearest position that is on the boundaries of all half-spaces in a set, and
    /// sets the multipliers l. Returns false if a multiplier is negative or the normals are nearly
    /// dependent; a smaller set then has the solution.
    bool meet(const HalfSpaceSet& set, Vec3& x, Vec3& l) const noexcept {
        // Gram matrix of the set's normals, padded with ones on the diagonal
        Mat3 gram = Mat3::Identity();
        Vec3 rhs = Vec3::Zero();
        for (size_t i = 0; i < set.size; ++i) {
            for (size_t j = 0; j < set.size; ++j)
                gram(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) =
                    n[set.index[i]].dot(n[set.index[j]]);
            rhs[static_cast<Eigen::Index>(i)] = b[set.index[i]] - n[set.index[i]].dot(x);
        }
        if (gram.determinant() < 1e-12) return false;
        l = gram.inverse() * rhs;
        for (size_t i = 0; i < set.size; ++i) {
            if (l[static_cast<Eigen::Index>(i)] < 0) return false;
            x += l[static_cast<Eigen::Index>(i)] * n[set.index[i]];
        }
        return true;
    }
};

}  // namespace dihaptic::haptics
