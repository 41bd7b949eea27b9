// Tests `dihaptic-bench contact` on other simulators' problems, and on unusable files.
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "bench/contact.h"
#include "bench/contact_file.h"
#include "recording/hdf5.h"
#include "testing/files.h"

namespace dihaptic::bench::contact_bench_test {
namespace {

using testing::TemporaryFolder;

/// Figures of one solver on all problems with up to `most_contacts`; every file must be usable.
std::vector<ContactFigures> measure_all(const std::string& folder, contact::Solver solver,
                                        int most_contacts,
                                        const contact::PolygonSettings& polygon = {}) {
    Diagnostics diagnostics;
    std::vector<std::string> files = contact_files({folder}, diagnostics);
    EXPECT_EQ(files.size(), 17u);
    std::erase_if(files, [&](const std::string& file) {
        return read_contact_file(file).mu.size() > most_contacts;
    });
    ContactBench bench;
    bench.solvers = {solver};
    bench.polygon = polygon;
    bench.peers = false;
    const std::vector<ContactFigures> out = bench_contact(files, bench, diagnostics, {});
    EXPECT_TRUE(diagnostics.problems().empty());
    EXPECT_EQ(out.size(), files.size());
    return out;
}

constexpr int kEvery = std::numeric_limits<int>::max();

TEST(BenchContact, NewtonSolvesEveryProblem) {
    DIHAPTIC_NEEDS_DATA(folder, "contact-problems");
    for (const ContactFigures& f : measure_all(folder, contact::Solver::newton, kEvery))
        EXPECT_LE(f.residual, 1e-8) << f.file;
}

TEST(BenchContact, StaggeredProjectionsSolveUpToSixtyContacts) {
    DIHAPTIC_NEEDS_DATA(folder, "contact-problems");
    for (const ContactFigures& f : measure_all(folder, contact::Solver::staggered_projections, 60))
        EXPECT_LE(f.residual, 1e-8) << f.file;
}

/// Number of problems that stewart_trinkle solves without fallback, to the residual of its own
/// problem and, where directions follow friction, also to Coulomb's.
int answered_by_its_own_means(const std::string& folder, contact::DirectionFrame frame) {
    int count = 0;
    for (const ContactFigures& f :
         measure_all(folder, contact::Solver::stewart_trinkle, 60, {8, frame})) {
        const bool own = f.route == "start" || f.route == "own_newton" || f.route == "lemke";
        EXPECT_EQ(own, !f.fallback) << f.file;
        if (!own) continue;
        ++count;
        EXPECT_LE(f.lcp_residual.value(), 1e-8) << f.file;
        if (frame == contact::DirectionFrame::sliding) {
            EXPECT_LE(f.residual, 1e-8) << f.file;
        }
    }
    return count;
}

TEST(BenchContact, StewartTrinkleSolvesItsOwnProblemByItsOwnMeans) {
    DIHAPTIC_NEEDS_DATA(folder, "contact-problems");
    EXPECT_GE(answered_by_its_own_means(folder, contact::DirectionFrame::fixed), 15);
    EXPECT_GE(answered_by_its_own_means(folder, contact::DirectionFrame::sliding), 15);
}

TEST(BenchContact, FixedDirectionsAnswerAnotherProblemThanCoulombs) {
    DIHAPTIC_NEEDS_DATA(folder, "contact-problems");
    int differ = 0;
    for (const ContactFigures& f : measure_all(folder, contact::Solver::stewart_trinkle, 60,
                                               {4, contact::DirectionFrame::fixed}))
        differ += !f.fallback && f.residual > 1e-5;
    EXPECT_GE(differ, 5);
}

TEST(BenchContact, SolvesTheProblemThatCarriesASolution) {
    DIHAPTIC_NEEDS_DATA(folder, "contact-problems");
    const contact::DelassusProblem problem = read_contact_file(folder + "/local_problem_test.hdf5");
    for (const contact::Solver solver :
         {contact::Solver::newton, contact::Solver::staggered_projections}) {
        contact::SolveStats stats;
        const Eigen::VectorXd r = contact::solve(solver, {}, problem, stats);
        EXPECT_LE(contact::natural_map_residual(problem, r), 1e-8) << enum_name(solver);
        EXPECT_FALSE(stats.missed);
    }
}

/// A file of one contact, a point mass of 1 kg on a plane, with the mistakes that a test makes.
struct Small {
    std::vector<double> q{-1, 0, 0};
    std::vector<double> mu{0.5};
    std::vector<int64_t> nz{-1};
    std::vector<int64_t> p{0, 1, 2, 3};
    std::vector<int64_t> i{0, 1, 2};
    std::vector<double> x{1, 1, 1};
    std::string without;

    std::string write(const std::string& file) const {
        namespace hdf5 = recording::hdf5;
        hdf5::Id out = hdf5::create_file(file);
        {
            const hdf5::Id local = hdf5::create_group(out, "fclib_local");
            const hdf5::Id matrix = hdf5::create_group(local, "W");
            const hdf5::Id vectors = hdf5::create_group(local, "vectors");
            const auto put = [&](const hdf5::Id& parent, const std::string& name,
                                 const auto& values) {
                if (name != without) hdf5::write_dataset(parent, name, values);
            };
            put(vectors, "q", q);
            put(vectors, "mu", mu);
            put(matrix, "nz", nz);
            put(matrix, "p", p);
            put(matrix, "i", i);
            put(matrix, "x", x);
        }
        hdf5::close(std::move(out));
        return file;
    }
};

/// The error for a file; "" if it can be used.
std::string fault(const std::string& file) {
    try {
        read_contact_file(file);
        return "";
    } catch (const Error& e) {
        return e.what();
    }
}

void expect_fault(const Small& small, const std::string& key, const std::string& what) {
    const TemporaryFolder folder;
    const std::string file = small.write(folder.file("problem.hdf5"));
    const std::string said = fault(file);
    EXPECT_NE(said.find(file + ": error: "), std::string::npos) << said;
    EXPECT_NE(said.find(key + ": "), std::string::npos) << said;
    EXPECT_NE(said.find(what), std::string::npos) << said;
}

TEST(ContactFile, IsReadByColumnsAndByRows) {
    const TemporaryFolder folder;
    Small small;
    small.i = {0, 1, 1};
    small.x = {1, 2, 5};
    const contact::DelassusProblem columns =
        read_contact_file(small.write(folder.file("columns.hdf5")));
    small.nz = {-2};
    const contact::DelassusProblem rows = read_contact_file(small.write(folder.file("rows.hdf5")));
    EXPECT_EQ(columns.W(1, 2), 5);
    EXPECT_EQ(columns.W(2, 1), 0);
    EXPECT_EQ(columns.W, rows.W.transpose());
    EXPECT_EQ(columns.q, Eigen::Vector3d(-1, 0, 0));
}

TEST(ContactFile, NamesWhatIsMissing) {
    for (const auto& [name, path] : {std::pair{"q", "fclib_local/vectors/q"},
                                     {"mu", "fclib_local/vectors/mu"},
                                     {"nz", "fclib_local/W/nz"},
                                     {"p", "fclib_local/W/p"},
                                     {"i", "fclib_local/W/i"},
                                     {"x", "fclib_local/W/x"}}) {
        Small small;
        small.without = name;
        expect_fault(small, path, "is missing");
    }
}

TEST(ContactFile, NamesValuesThatMeanNothing) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    Small small;
    small.q[1] = nan;
    expect_fault(small, "fclib_local/vectors/q", "not finite");
    small = {};
    small.mu[0] = std::numeric_limits<double>::infinity();
    expect_fault(small, "fclib_local/vectors/mu", "not finite");
    small = {};
    small.x[2] = nan;
    expect_fault(small, "fclib_local/W/x", "not finite");
    small = {};
    small.mu[0] = -0.1;
    expect_fault(small, "fclib_local/vectors/mu", "below zero");
    small = {};
    small.nz = {3};
    expect_fault(small, "fclib_local/W/nz", "neither");
}

TEST(ContactFile, NamesSizesThatDoNotFit) {
    Small small;
    small.q.push_back(0);
    expect_fault(small, "fclib_local/vectors", "three rows");
    small = {};
    small.p = {0, 1, 2};
    expect_fault(small, "fclib_local/W/p", "does not fit q");
    small = {};
    small.p = {0, 1, 2, 4};
    expect_fault(small, "fclib_local/W/p", "points outside");
    small = {};
    small.p = {-1, 1, 2, 3};
    expect_fault(small, "fclib_local/W/p", "points outside");
    small = {};
    small.i[0] = 3;
    expect_fault(small, "fclib_local/W/i", "points outside W");
    small = {};
    small.q.assign(9000, 0);
    small.mu.assign(3000, 0.5);
    expect_fault(small, "fclib_local/vectors/mu", "more than 2000 contacts");
}

TEST(ContactFile, NamesWhatIsNoSuchFile) {
    const TemporaryFolder folder;
    EXPECT_NE(fault(folder.file("gone.hdf5")).find("there is no such file"), std::string::npos);
    EXPECT_NE(fault(folder.path()).find("there is no such file"), std::string::npos);
    EXPECT_NE(fault(folder.write("text.hdf5", "not this\n")).find("is not an HDF5 file"),
              std::string::npos);
    EXPECT_NE(fault(folder.write("empty.hdf5", "")).find("is not an HDF5 file"), std::string::npos);
}

TEST(ContactFile, SurvivesBeingCutAnywhere) {
    const TemporaryFolder folder;
    const std::string whole = testing::read_file(Small{}.write(folder.file("whole.hdf5")));
    for (size_t length = 0; length < whole.size(); length += 1 + whole.size() / 60) {
        const std::string said = fault(folder.write("cut.hdf5", whole.substr(0, length)));
        EXPECT_NE(said.find("cut.hdf5: error: "), std::string::npos) << length;
    }
}

TEST(BenchContact, GoesOnAfterABadFile) {
    const TemporaryFolder folder;
    folder.write("a-bad.hdf5", "no");
    Small{}.write(folder.file("good.hdf5"));
    Diagnostics diagnostics;
    const std::vector<std::string> files =
        contact_files({folder.path(), folder.file("gone.hdf5")}, diagnostics);
    const std::vector<ContactFigures> figures = bench_contact(files, {}, diagnostics, {});
    EXPECT_EQ(diagnostics.problems().size(), 2u);
    ASSERT_GE(figures.size(), 3u);  // more with peers, in builds that have them
    for (const ContactFigures& f : figures) {
        EXPECT_EQ(f.file, folder.file("good.hdf5"));
        EXPECT_LE(f.residual, 1e-8) << f.solver;
        EXPECT_EQ(f.contacts, 1);
    }
}

TEST(BenchContact, AFolderWithoutProblemsIsAnError) {
    const TemporaryFolder folder;
    Diagnostics diagnostics;
    EXPECT_TRUE(contact_files({folder.path()}, diagnostics).empty());
    EXPECT_TRUE(diagnostics.has_errors());
}

}  // namespace
}  // namespace dihaptic::bench::contact_bench_test
