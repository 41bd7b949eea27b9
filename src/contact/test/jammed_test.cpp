// Grasps that are jammed between fingers and table, taken from the soak test of `measure`, which
// writes what it misses to such files. Before newton had caution, no method solved the first five
// (docs/adr/0034). The sixth was solved, but its answer could not be projected into the cone, and
// the attempt to sharpen it made it worse. Nothing moves, and the loads are not determined.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "contact/test/problems.h"
#include "contact/work.h"

namespace dihaptic::contact::jammed_test {
namespace {

struct Jammed {
    ContactProblem problem;
    std::vector<Impulse> start;  ///< impulses of the previous tick
};

/// Reads a problem from a file, which contains the numbers of bodies and contacts, followed by the
/// members of each body and each contact in order of declaration.
Jammed read(const std::filesystem::path& file) {
    std::ifstream in(file);
    const auto fill = [&](auto& matrix) {
        for (Eigen::Index i = 0; i < matrix.rows(); ++i) {
            for (Eigen::Index j = 0; j < matrix.cols(); ++j) in >> matrix(i, j);
        }
    };
    size_t bodies = 0;
    size_t contacts = 0;
    in >> bodies >> contacts;
    Jammed out;
    out.problem.bodies.resize(bodies);
    for (ProblemBody& body : out.problem.bodies) {
        fill(body.inverse_mass);
        fill(body.v_W);
        fill(body.w_W);
    }
    for (size_t j = 0; j < contacts; ++j) {
        ProblemContact& contact = out.problem.contacts.emplace_back();
        in >> contact.a >> contact.b;
        fill(contact.p_AC_W);
        fill(contact.p_BC_W);
        fill(contact.R_WC);
        in >> contact.bias;
        fill(contact.slip);
        in >> contact.friction >> contact.torsion_radius >> contact.compliance;
        fill(out.start.emplace_back(Impulse::Zero()));
    }
    EXPECT_TRUE(in) << file;
    return out;
}

TEST(JammedGrasps, AreAnsweredByNewtonAloneWithinATick) {
    int files = 0;
    for (const auto& entry : std::filesystem::directory_iterator("src/contact/test/jammed")) {
        const Jammed jammed = read(entry.path());
        ContactSolvers solvers;
        solvers.reserve(static_cast<int>(jammed.problem.bodies.size()),
                        static_cast<int>(jammed.problem.contacts.size()), false);
        for (const bool warm : {true, false}) {
            std::vector<Impulse> r = jammed.start;
            if (!warm) r.assign(r.size(), Impulse::Zero());
            Work tick(400'000);  // World::kMostSolveWork
            SolveStats stats;
            solvers.solve(Solver::newton, {{}, {}, kUnbounded, &tick}, jammed.problem, r, {},
                          stats);
            EXPECT_FALSE(stats.missed) << entry.path() << ": " << stats.residual;
            EXPECT_EQ(stats.route, Route::newton) << entry.path();
            EXPECT_LE(stats.residual, 1e-8);
            EXPECT_LT(tick.spent(), 200'000) << entry.path();
        }
        ++files;
    }
    EXPECT_EQ(files, 6);
}

}  // namespace
}  // namespace dihaptic::contact::jammed_test
