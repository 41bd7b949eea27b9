// The point nearest to v that obeys a few constraints n_i . x >= b_i:
//
//     minimise |x - v|^2 / 2    subject to    n_i . x >= b_i
//
// by its optimality conditions x = v + sum l_i n_i, l_i >= 0, l_i (n_i . x - b_i) = 0 (Zilles and
// Salisbury 1995). In space at most three constraints carry the solution, so all sets of up to
// three are tried, the smallest first: exact, and bounded work.
#pragma once

#include <array>
#include <cmath>
#include <limits>

#include "base/geometry.h"

namespace dihaptic::haptics {

constexpr size_t kMostHalfSpaces = 6;

struct HalfSpaces {
    std::array<Vec3, kMostHalfSpaces> n;  // unit
    std::array<double, kMostHalfSpaces> b{};
    std::array<double, kMostHalfSpaces> multiplier{};  // l, of the last nearest()
    size_t count = 0;

    void add(const Vec3& normal, double bound = 0) noexcept {
        n[count] = normal;
        b[count++] = bound;
    }

    /// x, and the multipliers. When nothing obeys all constraints: what misses them least.
    Vec3 nearest(const Vec3& v) noexcept {
        const double slack = 1e-13 + 1e-12 * v.norm();
        double least_miss = std::numeric_limits<double>::infinity();
        Vec3 best = v;
        std::array<double, kMostHalfSpaces> best_l{};
        const auto attempt = [&](std::array<size_t, 3> set, size_t size) {
            // Gram matrix of the set's normals, padded by ones
            Mat3 gram = Mat3::Identity();
            Vec3 rhs = Vec3::Zero();
            for (size_t i = 0; i < size; ++i) {
                for (size_t j = 0; j < size; ++j)
                    gram(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) =
                        n[set[i]].dot(n[set[j]]);
                rhs[static_cast<Eigen::Index>(i)] = b[set[i]] - n[set[i]].dot(v);
            }
            // normals that are as good as dependent: a smaller set has the answer
            if (gram.determinant() < 1e-12) return false;
            const Vec3 l = gram.inverse() * rhs;
            Vec3 x = v;
            for (size_t i = 0; i < size; ++i) {
                if (l[static_cast<Eigen::Index>(i)] < 0) return false;
                x += l[static_cast<Eigen::Index>(i)] * n[set[i]];
            }
            double miss = 0;
            for (size_t i = 0; i < count; ++i) miss = std::max(miss, b[i] - n[i].dot(x));
            if (miss >= least_miss) return false;
            least_miss = miss;
            best = x;
            best_l.fill(0);
            for (size_t i = 0; i < size; ++i) best_l[set[i]] = l[static_cast<Eigen::Index>(i)];
            return miss <= slack;
        };
        const auto search = [&] {
            if (attempt({}, 0)) return;
            for (size_t i = 0; i < count; ++i) {
                if (attempt({i}, 1)) return;
            }
            for (size_t i = 0; i < count; ++i) {
                for (size_t j = i + 1; j < count; ++j) {
                    if (attempt({i, j}, 2)) return;
                }
            }
            for (size_t i = 0; i < count; ++i) {
                for (size_t j = i + 1; j < count; ++j) {
                    for (size_t k = j + 1; k < count; ++k) {
                        if (attempt({i, j, k}, 3)) return;
                    }
                }
            }
        };
        search();
        multiplier = best_l;
        return best;
    }
};

}  // namespace dihaptic::haptics
