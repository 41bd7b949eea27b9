// The command `dihaptic-bench contact`: solves recorded contact problems with several solvers and
// compares them. docs/measures.md defines the figures.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "contact/solver_settings.h"
#include "measure/grasp.h"

namespace dihaptic::bench {

/// The solvers to compare.
struct ContactBench {
    std::vector<contact::Solver> solvers{
        contact::Solver::newton, contact::Solver::staggered_projections,
        contact::Solver::stewart_trinkle, contact::Solver::sequential_impulse};
    contact::PolygonSettings polygon;
    bool peers = true;  ///< whether to include other libraries' solvers, if this build has them
};

/// One problem, solved by one solver from zero impulses.
struct ContactFigures {
    std::string file;
    int contacts = 0;
    std::string solver;
    double residual = 0;                 ///< natural map over 1 + |q|, for the given problem
    std::optional<double> lcp_residual;  ///< stewart_trinkle: residual of its own problem
    double us = 0;                       ///< shortest time of several runs [us]
    int iterations = 0;
    std::string route;  ///< contact::Route that found the answer; empty for peers
    bool fallback = false;

    template <class Self, class Visitor>
    static void visit(Self& f, Visitor& v) {
        v("file", f.file, "", "");
        v("contacts", f.contacts, "1", "");
        v("solver", f.solver, "", "our solver, or a peer");
        v("residual", f.residual, "1", "natural map over 1 + |q|");
        v("us", f.us, "", "shortest time of several runs [us]");
        v("iterations", f.iterations, "1", "as counted by the solver");
        v("fallback", f.fallback, "", "whether another solver gave the answer");
        v("route", f.route, "", "method that gave the answer");
        v("lcp_residual", f.lcp_residual, "1", "of stewart_trinkle's own problem");
    }
};

/// The files named, with a folder replaced by the *.hdf5 files in it. A name that is neither a file
/// nor a folder is kept, so that reading it gives the error.
std::vector<std::string> contact_files(const std::vector<std::string>& names,
                                       Diagnostics& diagnostics);

/// Measures all files; those that cannot be used are reported to `diagnostics`.
std::vector<ContactFigures> bench_contact(const std::vector<std::string>& files,
                                          const ContactBench& bench, Diagnostics& diagnostics,
                                          const measure::Progress& progress);

}  // namespace dihaptic::bench
