#include "bench/contact.h"

#include <algorithm>
#include <filesystem>

#include "bench/contact_file.h"
#include "bench/duration.h"
#include "bench/siconos.h"
#include "contact/solver.h"

namespace dihaptic::bench {
namespace {

constexpr int kRuns = 7;
constexpr double kEnough = 0.3e6;  // no further run begins after this time [us]

/// Shortest time of several runs, each of which returns its time [us].
template <class Run>
double best_time(const Run& run) {
    double best = std::numeric_limits<double>::infinity();
    double sum = 0;
    for (int i = 0; i < kRuns && sum < kEnough; ++i) {
        const double us = run();
        best = std::min(best, us);
        sum += us;
    }
    return best;
}

ContactFigures measure(const contact::DelassusProblem& problem, contact::Solver solver,
                       const contact::PolygonSettings& polygon) {
    ContactFigures out;
    out.solver = std::string(enum_name(solver));
    contact::SolveStats stats;
    contact::SolveDetail detail;
    Eigen::VectorXd r;
    out.us = best_time([&] {
        return 1e6 * duration_of([&] {
                   r = contact::solve(solver, {polygon, {}, contact::kUnbounded}, problem, stats,
                                      &detail);
               });
    });
    out.residual = contact::natural_map_residual(problem, r);
    out.iterations = stats.iterations;
    out.fallback = stats.fallback;
    out.route = std::string(enum_name(stats.route));
    if (solver == contact::Solver::stewart_trinkle) out.lcp_residual = detail.lcp_residual;
    return out;
}

ContactFigures measure_peer(const contact::DelassusProblem& problem, const std::string& solver) {
    ContactFigures out;
    out.solver = solver;
    PeerAnswer answer;
    out.us = best_time([&] {
        answer = solve_by_siconos(solver, problem);
        return answer.us;
    });
    out.residual = contact::natural_map_residual(problem, answer.r);
    out.iterations = answer.iterations;
    return out;
}

}  // namespace

std::vector<std::string> contact_files(const std::vector<std::string>& names,
                                       Diagnostics& diagnostics) {
    std::vector<std::string> out;
    for (const std::string& name : names) {
        std::error_code error;
        if (!std::filesystem::is_directory(name, error)) {
            out.push_back(name);
            continue;
        }
        std::vector<std::string> inside;
        for (const auto& entry : std::filesystem::directory_iterator(name, error)) {
            if (entry.path().extension() == ".hdf5") inside.push_back(entry.path().string());
        }
        if (inside.empty()) {
            diagnostics.error({name, 0}, "", "is a folder without *.hdf5",
                              "Name a folder or files in the FCLIB layout.");
        }
        std::sort(inside.begin(), inside.end());
        out.insert(out.end(), inside.begin(), inside.end());
    }
    return out;
}

std::vector<ContactFigures> bench_contact(const std::vector<std::string>& files,
                                          const ContactBench& bench, Diagnostics& diagnostics,
                                          const measure::Progress& progress) {
    const std::vector<std::string> peers =
        bench.peers ? siconos_solvers() : std::vector<std::string>{};
    const size_t each = bench.solvers.size() + peers.size();
    std::vector<ContactFigures> out;
    for (size_t i = 0; i < files.size(); ++i) {
        const std::string& file = files[i];
        size_t step = i * each;
        const auto say = [&](const std::string& solver) {
            if (progress) {
                progress(std::filesystem::path(file).stem().string() + ", " + solver,
                         static_cast<double>(step++) / static_cast<double>(files.size() * each));
            }
        };
        contact::DelassusProblem problem;
        try {
            problem = read_contact_file(file);
        } catch (const Error& e) {
            diagnostics.add(e.problems());
            continue;
        }
        const auto add = [&](ContactFigures figures) {
            figures.file = file;
            figures.contacts = static_cast<int>(problem.mu.size());
            out.push_back(std::move(figures));
        };
        for (const contact::Solver solver : bench.solvers) {
            say(std::string(enum_name(solver)));
            add(measure(problem, solver, bench.polygon));
        }
        for (const std::string& peer : peers) {
            say(peer);
            add(measure_peer(problem, peer));
        }
    }
    return out;
}

}  // namespace dihaptic::bench
