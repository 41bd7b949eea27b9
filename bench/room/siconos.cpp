#include "bench/siconos.h"

#include "base/diagnostics.h"
#include "contact/solver.h"

#ifdef DIHAPTIC_PEERS
#include <FrictionContactProblem.h>
#include <Friction_cst.h>
#include <NonSmoothDrivers.h>
#include <NumericsMatrix.h>
#include <NumericsVerbose.h>
#include <SolverOptions.h>
#include <SparseBlockMatrix.h>

#include <chrono>
#include <memory>
#endif

namespace dihaptic::bench {

#ifdef DIHAPTIC_PEERS

std::vector<std::string> siconos_solvers() {
    return {"siconos_nsgs", "siconos_nsn"};
}

PeerAnswer solve_by_siconos(const std::string& solver, const contact::DelassusProblem& problem) {
    // copies, because Siconos writes to its input
    Eigen::MatrixXd W = problem.W;
    Eigen::VectorXd q = problem.q;
    Eigen::VectorXd mu = problem.mu;
    const auto n = static_cast<int>(q.size());
    NumericsMatrix* const M = NM_create_from_data(NM_DENSE, n, n, W.data());
    FrictionContactProblem fc3d{};
    fc3d.dimension = 3;
    fc3d.numberOfContacts = static_cast<int>(mu.size());
    fc3d.M = M;
    fc3d.q = q.data();
    fc3d.mu = mu.data();

    const bool newton = solver == "siconos_nsn";
    SolverOptions* const options =
        solver_options_create(newton ? SICONOS_FRICTION_3D_NSN_AC : SICONOS_FRICTION_3D_NSGS);
    options->dparam[SICONOS_DPARAM_TOL] = contact::kTolerance;
    options->iparam[SICONOS_IPARAM_MAX_ITER] = newton ? 1000 : 10000;
    numerics_set_verbose(0);

    PeerAnswer out;
    out.r = Eigen::VectorXd::Zero(n);
    Eigen::VectorXd velocity = Eigen::VectorXd::Zero(n);
    const auto begin = std::chrono::steady_clock::now();
    fc3d_driver(&fc3d, out.r.data(), velocity.data(), options);
    out.us =
        std::chrono::duration<double, std::micro>(std::chrono::steady_clock::now() - begin).count();
    out.iterations = options->iparam[SICONOS_IPARAM_ITER_DONE];

    solver_options_delete(options);
    std::free(options);
    M->matrix0 = nullptr;  // W owns the numbers
    NM_clear(M);
    std::free(M);
    return out;
}

#else

std::vector<std::string> siconos_solvers() {
    return {};
}

PeerAnswer solve_by_siconos(const std::string& solver, const contact::DelassusProblem&) {
    throw Error(solver + " is not in this build", "Run ./dev bench --peers.");
}

#endif

}  // namespace dihaptic::bench
