// Stewart and Trinkle's time-stepping linear complementarity problem (1996): Coulomb's disc is
// replaced by a polygon of n directions d_k,
//
//     0 <= r_N  _|_  u_N                    >= 0
//     0 <= b_k  _|_  d_k . u_T + lambda     >= 0        r_T = sum b_k d_k
//     0 <= lambda _|_ mu r_N - sum b_k      >= 0
//
// Directions are fixed in the contact frame, as in the literature, which makes friction between two
// directions weaker by up to cos(pi/n); or the first is laid along each contact's friction force,
// so that sliding is isotropic. A soft finger's torsion adds two directions, about +n and -n.
//
// Three ways lead to an answer, and which did is told: the cone's own solution, when it happens to
// solve this problem too (with aligned directions it nearly always does); Newton's method on the
// polygon; and Lemke's, in proximal steps that take its regularisation out of the answer.
#pragma once

#include <numbers>

#include "contact/lemke.h"
#include "contact/newton.h"

namespace dihaptic::contact {

enum class DirectionFrame { fixed, sliding };
constexpr auto enum_names(DirectionFrame) {
    return std::array{"fixed", "sliding"};
}

struct PolygonSettings {
    int directions = 8;
    DirectionFrame frame = DirectionFrame::sliding;
};

enum class StewartTrinkleRoute { none, cone, polygon_newton, lemke };

struct StewartTrinkleOutcome : Outcome {
    StewartTrinkleRoute route = StewartTrinkleRoute::none;
    double lcp_residual = 0;  ///< norm of min(z, w) over 1 + |q|, of the problem as given
};

constexpr int kMostDirections = 32;

/// Directions of one contact's friction, in its scaled tangent space (and spin).
template <int D>
struct Directions {
    Eigen::Matrix<double, D - 1, kMostDirections + 2> d;
    int count = 0;
};

template <class System>
struct StewartTrinkleMemory {
    NewtonMemory<System> newton;
    std::vector<Directions<System::D>> directions;
    std::vector<Polygon> polygons;
    std::vector<typename System::Vec> best;
    std::vector<double> last;  // z of the last proximal step
    Lemke lemke;

    /// Lemke's tableau grows with the square of the contacts: problems beyond `lemke_contacts` do
    /// without it.
    void reserve(size_t contacts, size_t lemke_contacts) {
        newton.reserve(contacts);
        directions.reserve(contacts);
        polygons.reserve(contacts);
        best.reserve(contacts);
        last.reserve(lemke_contacts * (kMostDirections + 4));
        lemke.reserve(static_cast<int>(lemke_contacts * 12));
    }
};

template <class System>
class StewartTrinkle {
  public:
    static constexpr int D = System::D;
    using Vec = typename System::Vec;

    StewartTrinkle(System& system, const PolygonSettings& settings, double tolerance,
                   StewartTrinkleMemory<System>& memory)
        : system_(system), settings_(settings), tolerance_(tolerance), m_(memory) {
        const size_t n = system.size();
        m_.directions.resize(n);
        m_.polygons.resize(n);
        m_.best.resize(n);
        m_.newton.resize(n);
        load_ = load(system);
    }

    /// Starts from r; leaves the best answer in r and its velocity in memory.newton.u.
    StewartTrinkleOutcome solve(std::span<Vec> r) {
        StewartTrinkleOutcome out;
        aim(r);
        std::copy(r.begin(), r.end(), m_.best.begin());
        system_.velocity(r, m_.newton.u);
        if (accept(r, StewartTrinkleRoute::cone, out)) return out;

        const Outcome cone = newton(system_, r, tolerance_, m_.newton);
        out.iterations += cone.iterations;
        aim(r);
        if (accept(r, StewartTrinkleRoute::cone, out)) return out;
        polygon_newton(r, out);
        if (!out.converged) lemke(r, out);
        std::copy(m_.best.begin(), m_.best.end(), r.begin());
        system_.velocity(r, m_.newton.u);
        return out;
    }

    /// Only Newton's method on the polygon, from r.
    StewartTrinkleOutcome solve_by_newton(std::span<Vec> r) {
        StewartTrinkleOutcome out;
        aim(r);
        polygon_newton(r, out);
        return out;
    }

    /// Only Lemke's method, from no impulse at all.
    StewartTrinkleOutcome solve_by_lemke(std::span<Vec> r) {
        StewartTrinkleOutcome out;
        aim(r);
        lemke(r, out);
        std::copy(m_.best.begin(), m_.best.end(), r.begin());
        system_.velocity(r, m_.newton.u);
        return out;
    }

    /// Norm of min(z, w), z = (r_N, b, lambda).
    Residual residual(std::span<const Vec> r, std::span<const Vec> u) {
        double scaled = 0;
        double given = 0;
        for (size_t j = 0; j < r.size(); ++j) {
            const Directions<D>& directions = m_.directions[j];
            const double mu = system_.scale(j).mu;
            const double unit = system_.unit(j);
            Eigen::Matrix<double, kMostDirections + 2, 1> beta;
            double sum = 0;
            double missing = resolve(j, r[j], beta, sum);
            double lambda = 0;
            for (int k = 0; k < directions.count; ++k) {
                lambda = std::max(lambda, -directions.d.col(k).dot(u[j].template tail<D - 1>()));
            }
            const auto add = [&](double z, double w, double z_unit) {
                const double in_system = std::min(z, w);
                const double as_given = std::min(z * z_unit, w / z_unit);
                scaled += in_system * in_system;
                given += as_given * as_given;
            };
            add(r[j][0], u[j][0], unit);
            for (int k = 0; k < directions.count; ++k) {
                add(beta[k], directions.d.col(k).dot(u[j].template tail<D - 1>()) + lambda, unit);
            }
            add(lambda, mu * r[j][0] - sum, 1 / unit);
            scaled += missing * missing;
            given += missing * missing * unit * unit;
        }
        return load_.residual(scaled, given);
    }

  private:
    /// Lays each contact's directions, along r where they follow sliding.
    void aim(std::span<const Vec> r) {
        for (size_t j = 0; j < r.size(); ++j) {
            using Tangent = Eigen::Matrix<double, D - 1, 1>;
            Tangent first = Tangent::UnitX();
            const Tangent r_t = r[j].template tail<D - 1>();
            if (settings_.frame == DirectionFrame::sliding && r_t.norm() > 0)
                first = r_t.normalized();
            Directions<D>& out = m_.directions[j];
            out.count = 0;
            Tangent second;
            if constexpr (D == 3) {
                second = {-first[1], first[0]};
                m_.polygons[j] = {settings_.directions, std::atan2(first[1], first[0])};
            } else {
                // across the first, in the tangent plane when that is possible
                second = Tangent{-first[1], first[0], 0};
                second = second.norm() > 1e-6 ? Tangent(second.normalized()) : Tangent::UnitX();
            }
            for (int k = 0; k < settings_.directions; ++k) {
                const double angle = 2 * std::numbers::pi * k / settings_.directions;
                out.d.col(out.count++) = std::cos(angle) * first + std::sin(angle) * second;
            }
            if constexpr (D == 4) {
                const Tangent third = first.cross(second);
                out.d.col(out.count++) = third;
                out.d.col(out.count++) = -third;
            }
        }
    }

    /// The friction of a contact as a sum of at most D - 1 of its directions; returns how much of
    /// it no sum of directions makes.
    double resolve(size_t j, const Vec& r, Eigen::Matrix<double, kMostDirections + 2, 1>& beta,
                   double& sum) const {
        using Tangent = Eigen::Matrix<double, D - 1, 1>;
        const Directions<D>& directions = m_.directions[j];
        beta.setZero();
        sum = 0;
        Tangent rest = r.template tail<D - 1>();
        if constexpr (D == 4) {
            const int last = directions.count - 2;
            const double along = directions.d.col(last).dot(rest);
            beta[along >= 0 ? last : last + 1] = std::abs(along);
            sum += std::abs(along);
            rest -= along * directions.d.col(last);
        }
        // the two directions on either side of what is left
        const int n = settings_.directions;
        const Tangent first = directions.d.col(0);
        Tangent second = directions.d.col(1) - directions.d.col(1).dot(first) * first;
        second.normalize();
        const Eigen::Vector2d plane(first.dot(rest), second.dot(rest));
        const Polygon polygon{n, 0};
        const int k = polygon.before(plane);
        const int next = (k + 1) % n;
        const double phi = std::atan2(plane[1], plane[0]) - polygon.direction_angle(k);
        const double pitch = 2 * std::numbers::pi / n;
        const double length = plane.norm();
        beta[next] = std::max(0.0, length * std::sin(phi) / std::sin(pitch));
        beta[k] += std::max(0.0, length * std::sin(pitch - phi) / std::sin(pitch));
        sum += beta[k] + beta[next];
        const Tangent made = beta[k] * directions.d.col(k) + beta[next] * directions.d.col(next);
        return (rest - made).norm();
    }

    bool accept(std::span<const Vec> r, StewartTrinkleRoute route, StewartTrinkleOutcome& out) {
        const Residual now = residual(r, m_.newton.u);
        if (now.judged() < out.residual) {
            out.residual = now.judged();
            out.lcp_residual = now.given;
            out.route = route;
            std::copy(r.begin(), r.end(), m_.best.begin());
        }
        out.converged = out.residual <= tolerance_;
        return out.residual <= kTarget * tolerance_;
    }

    /// Not with torsion.
    void polygon_newton(std::span<Vec> r, StewartTrinkleOutcome& out) {
        if constexpr (D == 3) {
            const law::Polygonal law{m_.polygons};
            const Outcome polygon =
                proximal_newton(system_, law, r, tolerance_, m_.newton,
                                [&](std::span<const Vec> impulse, std::span<const Vec> u) {
                                    return residual(impulse, u).judged();
                                });
            out.iterations += polygon.iterations;
            accept(r, StewartTrinkleRoute::polygon_newton, out);
        }
    }

    void fill(double rho, std::span<const double> last) {
        Lemke& lcp = m_.lemke;
        const int block = m_.directions[0].count + 2;
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
                for (int b = 0; b < D_k.count; ++b) {
                    const Vec column = W.template rightCols<D - 1>() * D_k.d.col(b);
                    lcp.M(j * block, k * block + 1 + b) = column[0];
                    for (int a = 0; a < D_j.count; ++a) {
                        lcp.M(j * block + 1 + a, k * block + 1 + b) =
                            D_j.d.col(a).dot(column.template tail<D - 1>());
                    }
                }
                for (int a = 0; a < D_j.count; ++a) {
                    lcp.M(j * block + 1 + a, k * block) =
                        D_j.d.col(a).dot(W.col(0).template tail<D - 1>());
                }
            }
            const auto q = system_.q(static_cast<size_t>(j));
            lcp.q(j * block) = q[0];
            lcp.M(lambda, j * block) = system_.scale(static_cast<size_t>(j)).mu;
            for (int a = 0; a < D_j.count; ++a) {
                lcp.q(j * block + 1 + a) = D_j.d.col(a).dot(q.template tail<D - 1>());
                lcp.M(j * block + 1 + a, lambda) = 1;
                lcp.M(lambda, j * block + 1 + a) = -1;
            }
            for (int i = j * block; i < lambda; ++i) {
                lcp.M(i, i) += rho;
                lcp.q(i) -= rho * last[static_cast<size_t>(i)];
            }
        }
    }

    void lemke(std::span<Vec> r, StewartTrinkleOutcome& out) {
        constexpr double kRho = 1e-3;
        constexpr int kMostProximal = 30;
        constexpr int kAttempts = 4;
        if (system_.size() == 0) return;
        Lemke& lcp = m_.lemke;
        const int block = m_.directions[0].count + 2;
        const int variables = static_cast<int>(system_.size()) * block;
        if (variables > lcp.capacity()) return;
        m_.last.assign(static_cast<size_t>(variables), 0.0);
        if (out.route != StewartTrinkleRoute::none) {  // begin at the best so far
            for (size_t j = 0; j < r.size(); ++j) {
                Eigen::Matrix<double, kMostDirections + 2, 1> beta;
                double sum = 0;
                resolve(j, m_.best[j], beta, sum);
                const size_t first = j * static_cast<size_t>(block);
                m_.last[first] = m_.best[j][0];
                for (int k = 0; k < m_.directions[j].count; ++k)
                    m_.last[first + 1 + static_cast<size_t>(k)] = beta[k];
            }
        }
        for (int step = 0; step < kMostProximal; ++step) {
            fill(kRho, m_.last);
            bool solved = step > 0 && lcp.try_last_basis();
            for (int attempt = 0; attempt < kAttempts && !solved; ++attempt)
                solved = lcp.solve(attempt);
            out.iterations += lcp.pivots() + 1;
            if (!solved) return;
            for (size_t j = 0; j < r.size(); ++j) {
                const int first = static_cast<int>(j) * block;
                r[j].setZero();
                r[j][0] = lcp.z(first);
                for (int k = 0; k < m_.directions[j].count; ++k) {
                    r[j].template tail<D - 1>() += lcp.z(first + 1 + k) * m_.directions[j].d.col(k);
                }
            }
            for (int i = 0; i < variables; ++i) m_.last[static_cast<size_t>(i)] = lcp.z(i);
            system_.velocity(r, m_.newton.u);
            if (accept(r, StewartTrinkleRoute::lemke, out)) return;
        }
    }

    System& system_;
    PolygonSettings settings_;
    double tolerance_;
    StewartTrinkleMemory<System>& m_;
    Load load_;
};

}  // namespace dihaptic::contact
