// Stewart and Trinkle's problem (stewart_trinkle.h) as a linear complementarity problem in
// z = (r_N, b_k, lambda), solved by Lemke's method in proximal steps.
#pragma once

#include <span>
#include <vector>

#include "contact/newton/newton.h"
#include "contact/polygon.h"
#include "contact/stewart_trinkle/lemke.h"

namespace dihaptic::contact {

template <class System>
struct PolygonLcpMemory {
    static constexpr int T = System::D - 1;
    /// The directions of one contact, stored for use in Lemke's matrix.
    using Directions = Eigen::Matrix<double, T, kMostDirections + 2>;

    std::vector<Directions> directions;
    std::vector<double> last;  // z from the last proximal step
    Lemke lemke;

    /// The size of Lemke's tableau grows with the square of the number of variables. Memory is
    /// reserved for twelve variables per contact of `lemke_contacts` (eight directions with
    /// torsion). Larger problems are solved without Lemke's method.
    void reserve(size_t contacts, size_t lemke_contacts) {
        directions.reserve(contacts);
        last.reserve(lemke_contacts * (kMostDirections + 4));
        lemke.reserve(static_cast<int>(lemke_contacts * 12));
    }
};

template <class System>
class PolygonLcp {
  public:
    static constexpr int T = System::D - 1;
    using Vec = typename System::Vec;

    /// The arguments must outlive this object. `polygons`: one for each contact.
    PolygonLcp(System& system, PolygonLcpMemory<System>& memory,
               const std::vector<Polygon<T>>& polygons)
        : system_(system), m_(memory), polygons_(polygons) {}

    /// Whether there are contacts, and no more variables than memory is reserved for.
    bool fits() const { return system_.size() > 0 && variables() <= m_.lemke.capacity(); }

    /// Sets the start of the proximal steps to z of the impulses r, or to zero if r is empty.
    void begin(std::span<const Vec> r) {
        m_.directions.resize(polygons_.size());
        for (size_t j = 0; j < polygons_.size(); ++j) {
            for (int k = 0; k < directions(); ++k)
                m_.directions[j].col(k) = polygons_[j].direction(k);
        }
        m_.last.assign(static_cast<size_t>(variables()), 0.0);
        for (size_t j = 0; j < r.size(); ++j) {
            const auto in = polygons_[j].sector(r[j].template tail<T>());
            const Eigen::Matrix<double, T, 1> b = in.inverse * r[j].template tail<T>();
            const size_t first = j * static_cast<size_t>(block());
            m_.last[first] = r[j][0];
            for (int i = 0; i < T; ++i) {
                const auto at = static_cast<size_t>(in.index[static_cast<size_t>(i)]);
                m_.last[first + 1 + at] = std::max(0.0, b[i]);
            }
        }
    }
    /// Whether the remaining work suffices to fill in the problem; if so, spends that work.
    bool affords() {
        constexpr int64_t kOfEach = 4;  // each entry needs a product and is copied into the tableau
        const int64_t n = variables();
        const int64_t visits = kOfEach * n * n / Visits::entries + 1;
        if (!system_.work().affords(visits)) return false;
        system_.work().spend(visits);
        return true;
    }
    /// Takes a proximal step. `again`: whether the last step's basis may solve this step, too.
    bool solve(bool again) {
        fill();
        return (again && try_last_basis()) || pivot();
    }
    int pivots() const { return m_.lemke.pivots(); }
    /// Stores the impulses of the last step in r, and starts the next step from there.
    void take(std::span<Vec> r) {
        for (size_t j = 0; j < r.size(); ++j) {
            const int first = static_cast<int>(j) * block();
            r[j].setZero();
            r[j][0] = m_.lemke.z(first);
            for (int k = 0; k < directions(); ++k)
                r[j].template tail<T>() += m_.lemke.z(first + 1 + k) * m_.directions[j].col(k);
        }
        for (int i = 0; i < variables(); ++i) m_.last[static_cast<size_t>(i)] = m_.lemke.z(i);
    }

  private:
    static constexpr double kRho = 1e-3;

    int directions() const { return polygons_[0].count(); }
    int block() const { return directions() + 2; }  // number of variables of a contact
    int variables() const { return static_cast<int>(system_.size()) * block(); }

    void fill() {
        Lemke& lcp = m_.lemke;
        const int directions = this->directions();
        const int block = this->block();
        const auto n = static_cast<int>(system_.size());
        lcp.start(n * block);
        for (int j = 0; j < n; ++j) {
            const auto& D_j = m_.directions[static_cast<size_t>(j)];
            const int lambda = j * block + block - 1;
            for (int k = 0; k < n; ++k) {
                const auto W =
                    system_.delassus_block(static_cast<size_t>(j), static_cast<size_t>(k));
                const auto& D_k = m_.directions[static_cast<size_t>(k)];
                lcp.M(j * block, k * block) = W(0, 0);
                for (int b = 0; b < directions; ++b) {
                    const Vec column = W.template rightCols<T>() * D_k.col(b);
                    lcp.M(j * block, k * block + 1 + b) = column[0];
                    for (int a = 0; a < directions; ++a) {
                        lcp.M(j * block + 1 + a, k * block + 1 + b) =
                            D_j.col(a).dot(column.template tail<T>());
                    }
                }
                for (int a = 0; a < directions; ++a) {
                    lcp.M(j * block + 1 + a, k * block) =
                        D_j.col(a).dot(W.col(0).template tail<T>());
                }
            }
            const auto q = system_.q(static_cast<size_t>(j));
            lcp.q(j * block) = q[0];
            lcp.M(lambda, j * block) = system_.scale(static_cast<size_t>(j)).mu;
            for (int a = 0; a < directions; ++a) {
                lcp.q(j * block + 1 + a) = D_j.col(a).dot(q.template tail<T>());
                lcp.M(j * block + 1 + a, lambda) = 1;
                lcp.M(lambda, j * block + 1 + a) = -1;
            }
            for (int i = j * block; i < lambda; ++i) {
                lcp.M(i, i) += kRho;
                lcp.q(i) -= kRho * m_.last[static_cast<size_t>(i)];
            }
        }
    }

    bool try_last_basis() {
        const int64_t visits = m_.lemke.basis_entries() / Visits::entries + 1;
        if (!system_.work().affords(visits)) return false;
        system_.work().spend(visits);
        return m_.lemke.try_last_basis();
    }
    /// Pivots along one covering vector after another until one succeeds.
    bool pivot() {
        constexpr int kAttempts = 4;
        const int64_t visits = m_.lemke.pivot_entries() / Visits::entries + 1;
        for (int attempt = 0; attempt < kAttempts; ++attempt) {
            const int before = m_.lemke.pivots();
            const bool solved = m_.lemke.solve(attempt, system_.work().times(visits));
            // a search starts by filling the tableau
            system_.work().spend(visits * (1 + m_.lemke.pivots() - before));
            if (solved) return true;
        }
        return false;
    }

    System& system_;
    PolygonLcpMemory<System>& m_;
    const std::vector<Polygon<T>>& polygons_;
};

}  // namespace dihaptic::contact
