// Stewart and Trinkle's time-stepping linear complementarity problem (1996): Coulomb's disc is
// replaced by a polygon of n directions d_k,
//
//     0 <= r_N  _|_  u_N                    >= 0
//     0 <= b_k  _|_  d_k . u_T + lambda     >= 0        r_T = sum b_k d_k
//     0 <= lambda _|_ mu r_N - sum b_k      >= 0
//
// Directions are fixed in the contact frame, as in the literature, which makes friction between two
// directions weaker by a factor down to cos(pi/n); or the first direction is aligned with each
// contact's friction force, so that sliding is isotropic. Torsion of a soft finger adds two
// directions, about +n and -n.
//
// Two methods solve it, and the statistics report which one did: Newton's method on the polygon
// and, if that fails, Lemke's method in proximal steps, which remove the regularisation from the
// answer. If directions follow friction, the problem is solved with the current directions, the
// directions are turned, and the problem is solved again, until friction opposes sliding: the
// answer then obeys Coulomb's law as well.
#pragma once

#include <array>
#include <numbers>

#include "contact/anderson.h"
#include "contact/newton/newton.h"
#include "contact/route.h"
#include "contact/solver_settings.h"
#include "contact/stewart_trinkle/polygon_lcp.h"

namespace dihaptic::contact {

/// Starts for Newton's method on a polygon. Each turn of the polygons needs a solve, so every solve
/// must be short: there are twelve short starts from random impulses instead of four with caution,
/// which would leave less work for Lemke's method.
constexpr auto kPolygonStarts = [] {
    using From = NewtonStart::From;
    std::array<NewtonStart, 14> out{};
    out[0] = kNewtonStarts[0];
    out[1] = kNewtonStarts[1];
    for (size_t i = 2; i < out.size(); ++i) {
        const bool full = i % 2 == 1;
        out[i] = {From::scattered, full ? 1e-3 : 1e-2, 100, 20, 40, true, full ? 0 : 4, 2};
    }
    return out;
}();

struct StewartTrinkleOutcome : Outcome {
    Route route = Route::none;
    double lcp_residual = 0;  ///< norm of min(z, w) divided by 1 + |q|, for the given problem
};

template <class System>
struct StewartTrinkleMemory {
    static constexpr int T = System::D - 1;
    NewtonMemory<System> newton;
    std::vector<Polygon<T>> polygons;
    std::vector<typename System::Vec> best;
    std::vector<double> aim;    // the first direction given to each polygon
    std::vector<double> image;  // the first direction that the resulting answer requires
    Anderson anderson;
    PolygonLcpMemory<System> lcp;

    void reserve(size_t contacts, size_t lemke_contacts) {
        newton.reserve(contacts);
        polygons.reserve(contacts);
        best.reserve(contacts);
        aim.reserve(contacts * T);
        image.reserve(contacts * T);
        anderson.reserve(contacts * T);
        lcp.reserve(contacts, lemke_contacts);
    }
};

template <class System>
class StewartTrinkle {
  public:
    static constexpr int D = System::D;
    static constexpr int T = D - 1;
    using Vec = typename System::Vec;
    using Tangent = Eigen::Matrix<double, T, 1>;
    using Shares = Eigen::Matrix<double, T, 1>;

    StewartTrinkle(System& system, const PolygonSettings& settings, double tolerance,
                   StewartTrinkleMemory<System>& memory)
        : system_(system), settings_(settings), tolerance_(tolerance), m_(memory) {
        const size_t n = system.size();
        m_.polygons.assign(n, {settings.directions});
        m_.best.resize(n);
        m_.newton.resize(n);
        m_.aim.resize(n * T);
        m_.image.resize(n * T);
        load_ = load(system);
    }

    /// Starts from r; leaves the best answer in r, and the velocity for that answer in
    /// memory.newton.u. `converged` means that Stewart and Trinkle's problem is solved and, if
    /// directions follow friction, Coulomb's as well.
    StewartTrinkleOutcome solve(std::span<Vec> r) {
        StewartTrinkleOutcome out;
        std::copy(r.begin(), r.end(), m_.best.begin());
        system_.velocity(r, m_.newton.u);
        if (follows()) turn(r);
        if (accept(r, Route::start, out)) return out;
        solve_and_turn(r, out, [&](double enough) { newton_once(r, enough, out); });
        // Lemke's variables are non-negative, but the impulse of a joint row can have any sign
        if (!out.converged && !system_.has_joints())
            solve_and_turn(r, out, [&](double enough) { lemke_once(r, enough, out); });
        restore(r);
        return out;
    }

    /// Uses only Lemke's method, starting from zero impulses.
    StewartTrinkleOutcome solve_by_lemke(std::span<Vec> r) {
        StewartTrinkleOutcome out;
        for (Vec& impulse : r) impulse.setZero();
        system_.velocity(r, m_.newton.u);
        if (follows()) turn(r);
        solve_and_turn(r, out, [&](double enough) { lemke_once(r, enough, out); });
        restore(r);
        return out;
    }

    /// Norm of min(z, w), with z = (r_N, b, lambda), for the current polygons.
    Residual residual(std::span<const Vec> r, std::span<const Vec> u) const {
        double scaled = 0;
        double given = 0;
        for (size_t j = 0; j < r.size(); ++j) {
            const double unit = system_.unit(j);
            if (const JointScale* joint = system_.scale(j).joint; joint != nullptr) {
                scaled += law::Joint::residual<D>(*joint, r[j], u[j]);
                given += law::Joint::residual<D>(*joint, r[j], u[j], unit);
                continue;
            }
            const Tangent u_t = u[j].template tail<T>();
            const double lambda = std::max(0.0, m_.polygons[j].support(-u_t));
            const auto in = m_.polygons[j].sector(r[j].template tail<T>());
            const auto add = [&](double z, double w, double z_unit) {
                const double in_system = std::min(z, w);
                const double as_given = std::min(z * z_unit, w / z_unit);
                scaled += in_system * in_system;
                given += as_given * as_given;
            };
            const Shares b = in.inverse * r[j].template tail<T>();
            add(r[j][0], u[j][0], unit);
            // the other directions have zero coefficients and w >= 0
            for (int i = 0; i < T; ++i) add(b[i], in.vertices.col(i).dot(u_t) + lambda, unit);
            add(lambda, system_.scale(j).mu * r[j][0] - b.sum(), 1 / unit);
        }
        return load_.residual(scaled, given);
    }

  private:
    /// Limits of solve_and_turn(). After a small turn, the answer for the last polygons is a warm
    /// start.
    static constexpr int kMostTurns = 60;
    static constexpr double kInnerOfLast = 1e-3;
    static constexpr size_t kMostWork = 32000;  // contacts times steps, as in newton.h

    bool follows() const { return settings_.frame == DirectionFrame::sliding; }

    /// Aligns the first directions with z = r_T - a_T u_T, the direction of friction according to
    /// the law: along r_T where the contact sticks, against u_T where it slides.
    void turn(std::span<const Vec> r) {
        for (size_t j = 0; j < r.size(); ++j) m_.polygons[j].turn_to(asked(j, r[j]));
    }
    Tangent asked(size_t j, const Vec& r) const {
        return r.template tail<T>() - system_.scale(j).a_t * m_.newton.u[j].template tail<T>();
    }
    /// Turns the polygons like turn(), but as one step of an iteration that is accelerated using
    /// its last steps. Open contacts, and contacts that stick inside their polygon, do not turn:
    /// their directions would only disturb the others.
    void turn_faster(std::span<const Vec> r) {
        constexpr double kInside = 1e-9;
        using Map = Eigen::Map<Tangent>;
        for (size_t j = 0; j < r.size(); ++j) {
            Map now(&m_.aim[j * T]);
            Map next(&m_.image[j * T]);
            const Polygon<T>& polygon = m_.polygons[j];
            now = next = polygon.axes.col(0);
            const Tangent r_t = r[j].template tail<T>();
            const double limit = system_.scale(j).mu * r[j][0];
            if (limit <= 0 || (polygon.sector(r_t).inverse * r_t).sum() < (1 - kInside) * limit)
                continue;
            const Tangent along = asked(j, r[j]);
            if (along.norm() > 0) next = along.normalized();
        }
        system_.work().spend(Visits::acceleration * static_cast<int64_t>(r.size()));
        m_.anderson.advance(m_.aim, m_.image);
        for (size_t j = 0; j < r.size(); ++j) m_.polygons[j].turn_to(Map(&m_.aim[j * T]));
    }

    /// Calls `once` to solve the problem with the current polygons and, if directions follow
    /// friction, again after each turn.
    template <class Once>
    void solve_and_turn(std::span<Vec> r, StewartTrinkleOutcome& out, const Once& once) {
        m_.anderson.start(m_.aim.size());
        double last = std::numeric_limits<double>::infinity();
        for (int turn = 0; turn <= kMostTurns; ++turn) {
            once(std::isfinite(last) ? kInnerOfLast * last : 0);
            if (!follows() || out.residual <= kTarget * tolerance_ ||
                (out.converged && residual_ > kStalledShare * last) ||
                static_cast<size_t>(out.iterations) * r.size() > kMostWork ||
                !system_.work().affords(system_.step_visits()))
                return;
            last = residual_;
            turn_faster(r);
        }
    }

    /// Stores r if it is the best so far. Returns whether it is good enough.
    bool accept(std::span<const Vec> r, Route route, StewartTrinkleOutcome& out) {
        using Law = law::Polygonal<T>;
        system_.work().spend(Law::kVisits * static_cast<int64_t>(r.size()));
        const std::span<const Vec> u(m_.newton.u);
        const Residual own = residual(r, u);
        residual_ = own.judged();
        if (follows())
            residual_ = std::max(residual_, coulomb_residual(system_, r, u, load_).judged());
        if (residual_ < out.residual) {
            out.residual = residual_;
            out.lcp_residual = own.given;
            out.route = route;
            std::copy(r.begin(), r.end(), m_.best.begin());
        }
        out.converged = out.residual <= tolerance_;
        return out.residual <= kTarget * tolerance_;
    }
    void restore(std::span<Vec> r) {
        std::copy(m_.best.begin(), m_.best.end(), r.begin());
        system_.velocity(r, m_.newton.u);
    }

    /// Solves by Newton's method, at least down to the residual `enough`.
    void newton_once(std::span<Vec> r, double enough, StewartTrinkleOutcome& out) {
        auto starts = kPolygonStarts;
        if (enough > 0) {  // start from the answer for slightly different polygons
            starts[0].rho = std::clamp(residual_, 1e-7, starts[0].rho);
            starts[0].sweeps = 0;
        }
        const Outcome outcome = proximal_newton(
            system_, law::Polygonal<T>{m_.polygons}, r, std::max(tolerance_, enough), m_.newton,
            [&](std::span<const Vec> impulse, std::span<const Vec> u) {
                return residual(impulse, u).judged();
            },
            starts);
        out.iterations += outcome.iterations;
        accept(r, Route::own_newton, out);
    }

    /// Solves by Lemke's method, at least down to the residual `enough`.
    void lemke_once(std::span<Vec> r, double enough, StewartTrinkleOutcome& out) {
        constexpr int kMostProximal = 30;
        PolygonLcp<System> lcp(system_, m_.lcp, m_.polygons);
        if (!lcp.fits()) return;
        lcp.begin(out.route == Route::none ? std::span<const Vec>() : m_.best);
        for (int step = 0; step < kMostProximal; ++step) {
            if (!lcp.affords()) return;
            const bool solved = lcp.solve(step > 0);
            out.iterations += lcp.pivots() + 1;
            if (!solved) return;
            lcp.take(r);
            system_.velocity(r, m_.newton.u);
            if (accept(r, Route::lemke, out)) return;
            if (residual(r, m_.newton.u).judged() <= kTarget * std::max(tolerance_, enough)) return;
        }
    }

    System& system_;
    PolygonSettings settings_;
    double tolerance_;
    StewartTrinkleMemory<System>& m_;
    Load load_;
    double residual_ = std::numeric_limits<double>::infinity();  ///< residual of the last attempt
};

}  // namespace dihaptic::contact
