// `dihaptic bench contact`: definitions in docs/measures.md.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "contact/solver_settings.h"
#include "measure/grasp.h"

namespace dihaptic::measure {

/// What is to be solved with what.
struct ContactBench {
    std::vector<contact::Solver> solvers{contact::Solver::newton,
                                         contact::Solver::staggered_projections,
                                         contact::Solver::stewart_trinkle};
    contact::PolygonSettings polygon;
    bool peers = true;  ///< those too that this build knows
};

/// One problem, solved by one solver from zero impulses.
struct ContactFigures {
    std::string file;
    int contacts = 0;
    std::string solver;
    double residual = 0;                 ///< natural map over 1 + |q|, of the problem as given
    std::optional<double> lcp_residual;  ///< stewart_trinkle: of its own problem
    double us = 0;                       ///< the best of several runs
    int iterations = 0;
    std::string route;  ///< what found the answer: a contact::Route; none of peers
    bool fallback = false;
};

/// The files named, with a folder's *.hdf5 in place of the folder. What is neither goes through:
/// whoever reads it says so.
std::vector<std::string> contact_files(const std::vector<std::string>& names,
                                       Diagnostics& diagnostics);

/// Files that cannot be used go to `diagnostics`; the others are measured.
std::vector<ContactFigures> bench_contact(const std::vector<std::string>& files,
                                          const ContactBench& bench, Diagnostics& diagnostics,
                                          const Progress& progress);

std::string to_json(const std::vector<ContactFigures>& figures);
std::string to_table(const std::vector<ContactFigures>& figures);

}  // namespace dihaptic::measure
