#include <fmt/format.h>

#include <algorithm>

#include "command.h"
#include "experiment/plan.h"
#include "measure/contact.h"
#include "measure/friction.h"
#include "measure/grasp.h"
#include "measure/jitter.h"
#include "measure/scale.h"
#include "measure/solvers.h"
#include "measure/view.h"

namespace dihaptic::cli {
namespace {

struct BenchOptions {
    measure::BenchSetup setup;
    std::string solver;
    std::string coupling;
    std::string proxy;
    std::vector<std::string> set;
    bool json = false;
};

void add_common(CLI::App& command, BenchOptions& options) {
    command.add_option(
        "--solver", options.solver,
        "contact solver: sequential_impulse, stewart_trinkle, staggered_projections, newton");
    command.add_option("--coupling", options.coupling,
                       "coupling of handle and proxy: implicit, dual_spring, velocity_impulse");
    command.add_option("--rate", options.setup.settings.rate, "ticks a second [Hz]")
        ->check(rate_range())
        ->capture_default_str();
    command.add_flag("--json", options.json, "one JSON object on standard output, nothing else");
}

template <class E>
void choose(const std::string& word, const char* option, E& value) {
    if (word.empty()) return;
    const auto names = enum_names(value);
    for (size_t i = 0; i < names.size(); ++i) {
        if (word == names[i]) {
            value = static_cast<E>(i);
            return;
        }
    }
    throw Error({option, 0}, word, "is not known", "See --help.");
}

void resolve(BenchOptions& options) {
    choose(options.solver, "--solver", options.setup.settings.dynamics.solver);
    choose(options.proxy, "--proxy", options.setup.settings.proxy.kind);
    choose(options.coupling, "--coupling", options.setup.settings.coupling.kind);
    for (const std::string& text : options.set)
        experiment::apply_setting(options.setup.settings, text);
}

void add_grasp(CLI::App& bench) {
    auto* command = bench.add_subcommand(
        "grasp", "Two fingers lift and hold a block: how still, how true, up to which stiffness");
    auto options = std::make_shared<BenchOptions>();
    add_common(*command, *options);
    command->add_option("--proxy", options->proxy, "what a finger is in the world: rigid, point");
    command->add_option("--mass", options->setup.mass, "of the block [kg]")->capture_default_str();
    command->add_option("--friction", options->setup.friction, "coefficient")
        ->capture_default_str();
    command->add_option("--set", options->set,
                        "any other setting, e.g. coupling.onset_ms=20; may be repeated");
    command->footer(
        "\nWithout --coupling the table has both couplings of rigid proxies, and of points "
        "friction "
        "together with the dynamics and apart; the JSON object the default one.\n\nExamples:\n"
        "  dihaptic bench grasp --coupling dual_spring --mass 0.2\n"
        "  dihaptic bench grasp --set coupling.onset_ms=20");
    command->callback([options] {
        resolve(*options);
        std::vector<measure::GraspResult> results{{options->setup, {}}};
        const bool rigid = options->setup.settings.proxy.kind == haptics::ProxyKind::rigid;
        if (!options->json && options->coupling.empty() && rigid) {
            results.push_back(results.front());
            results.back().setup.settings.coupling.kind = haptics::CouplingKind::dual_spring;
        }
        if (!options->json && !rigid) {
            results.push_back(results.front());
            results.back().setup.settings.proxy.friction = haptics::PointFriction::apart;
        }
        {
            ProgressLine line("bench grasp");
            for (size_t i = 0; i < results.size(); ++i) {
                results[i].figures = measure::bench_grasp(
                    results[i].setup, [&](const std::string& what, double share) {
                        line.show(
                            (static_cast<double>(i) + share) / static_cast<double>(results.size()),
                            what);
                    });
            }
        }
        fmt::print("{}", options->json ? to_json(results.front().figures, options->setup)
                                       : to_table(results));
    });
}

void add_friction(CLI::App& bench) {
    auto* command = bench.add_subcommand(
        "friction", "Inclines, a stack, a house of cards, an arch, and a held block's creep");
    auto options = std::make_shared<BenchOptions>();
    command->add_option("--solver", options->solver,
                        "only this contact solver; otherwise all, and peers");
    command->add_flag("--json", options->json, "one JSON object on standard output, nothing else");
    command->footer("\nExample:\n  dihaptic bench friction");
    command->callback([options] {
        resolve(*options);
        std::vector<dynamics::Solver> solvers{options->setup.settings.dynamics.solver};
        std::vector<measure::Simulator> peers;
        if (options->solver.empty()) {
            solvers.clear();
            for (int i = 0; i < contact::kSolvers; ++i)
                solvers.push_back(static_cast<dynamics::Solver>(i));
            peers = measure::peer_simulators();
        }
        std::vector<measure::FrictionFigures> figures;
        {
            ProgressLine line("bench friction");
            const auto say = [&](std::string_view name) {
                const auto done = static_cast<double>(figures.size());
                const auto all = static_cast<double>(solvers.size() + peers.size());
                return [&line, name, done, all](const std::string& what, double share) {
                    line.show((done + share) / all, fmt::format("{}, {}", name, what));
                };
            };
            for (const dynamics::Solver solver : solvers) {
                dynamics::Settings settings = options->setup.settings.dynamics;
                settings.solver = solver;
                figures.push_back(measure::bench_friction(settings, say(enum_name(solver))));
            }
            for (const measure::Simulator& peer : peers)
                figures.push_back(measure::bench_peer_friction(peer, say(peer.name)));
        }
        fmt::print("{}", options->json ? to_json(figures) : to_table(figures));
    });
}

void add_scale(CLI::App& bench) {
    auto* command =
        bench.add_subcommand("scale", "What a tick costs with 0 to 1000 more blocks on the table");
    auto options = std::make_shared<BenchOptions>();
    // the bare step that it is compared with is Bullet's
    options->setup.settings.dynamics.solver = dynamics::Solver::sequential_impulse;
    auto extras = std::make_shared<std::vector<int>>(std::vector<int>{0, 10, 50, 200, 1000});
    add_common(*command, *options);
    command->add_option("--extra", *extras, "numbers of extra blocks")->capture_default_str();
    command->footer("\nExample:\n  dihaptic bench scale --extra 0 10 50");
    command->callback([options, extras] {
        resolve(*options);
        std::vector<measure::ScaleFigures> figures;
        {
            ProgressLine line("bench scale");
            figures = measure::bench_scale(
                options->setup, *extras,
                [&](const std::string& what, double share) { line.show(share, what); });
        }
        fmt::print("{}", options->json ? to_json(figures) : to_table(figures));
    });
}

void add_contact(CLI::App& bench) {
    struct ContactOptions {
        std::vector<std::string> files;
        std::string solver;
        std::string frame;
        measure::ContactBench bench;
        bool json = false;
    };
    auto* command = bench.add_subcommand(
        "contact", "Contact problems from files: residual, time and iterations of each solver");
    auto options = std::make_shared<ContactOptions>();
    command
        ->add_option("files", options->files,
                     "contact problems in the FCLIB layout (HDF5), or folders of *.hdf5")
        ->required();
    command->add_option("--solver", options->solver,
                        "only this one: newton, staggered_projections, stewart_trinkle; otherwise "
                        "these and the peers that are installed");
    command
        ->add_option("--directions", options->bench.polygon.directions,
                     "of stewart_trinkle's friction polygon")
        ->check(CLI::Range(4, contact::kMostDirections))
        ->capture_default_str();
    command->add_option("--direction-frame", options->frame,
                        "where they lie: sliding (the first along each contact's friction), fixed");
    command->add_flag("--json", options->json, "one JSON object on standard output, nothing else");
    command->footer(
        "\nExample:\n  dihaptic bench contact ../shared/data/contact-problems --solver newton");
    command->callback([options] {
        measure::ContactBench& wanted = options->bench;
        choose(options->frame, "--direction-frame", wanted.polygon.frame);
        if (!options->solver.empty()) {
            contact::Solver solver{};
            choose(options->solver, "--solver", solver);
            if (solver == contact::Solver::sequential_impulse)
                throw Error({"--solver", 0}, options->solver, "solves bodies, which files lack",
                            "Choose another, or see dihaptic bench solvers.");
            wanted.solvers = {solver};
            wanted.peers = false;
        }
        Diagnostics diagnostics;
        std::vector<measure::ContactFigures> figures;
        {
            ProgressLine line("bench contact");
            figures = measure::bench_contact(
                measure::contact_files(options->files, diagnostics), wanted, diagnostics,
                [&](const std::string& what, double share) { line.show(share, what); });
        }
        if (options->json || !figures.empty())
            fmt::print("{}", options->json ? to_json(figures) : to_table(figures));
        print(diagnostics.problems());
        if (diagnostics.has_errors()) exit_code = kBadInput;
    });
}

void add_solvers(CLI::App& bench) {
    auto* command = bench.add_subcommand(
        "solvers", "What a solve costs by contacts, beside Bullet's, on problems of shaken scenes");
    auto solver_name = std::make_shared<std::string>();
    auto json = std::make_shared<bool>(false);
    command->add_option("--solver", *solver_name,
                        "only this one, beside Bullet's: newton, staggered_projections, "
                        "stewart_trinkle, sequential_impulse");
    command->add_flag("--json", *json, "one JSON object on standard output, nothing else");
    command->footer("\nExample:\n  dihaptic bench solvers --solver newton");
    command->callback([solver_name, json] {
        measure::SolversBench wanted;
        if (!solver_name->empty()) {
            contact::Solver solver{};
            choose(*solver_name, "--solver", solver);
            wanted.solvers = {solver};
            if (solver == contact::Solver::sequential_impulse) wanted.solvers.clear();
        }
        measure::SolversFigures figures;
        {
            ProgressLine line("bench solvers");
            figures = measure::bench_solvers(
                wanted, [&](const std::string& what, double share) { line.show(share, what); });
        }
        fmt::print("{}", *json ? to_json(figures) : to_table(figures));
    });
}

void add_jitter(CLI::App& bench) {
    auto* command = bench.add_subcommand(
        "jitter",
        "How punctual the real-time thread is, beside cyclictest, and how long ticks take");
    auto options = std::make_shared<BenchOptions>();
    auto time = std::make_shared<double>(60);
    command->add_option("--time", *time, "in real time, cyclictest's as much again [s]")
        ->check(time_range())
        ->capture_default_str();
    command
        ->add_option("--extra", options->setup.extra_blocks, "more blocks on the table, kept awake")
        ->check(CLI::Range(0, 1000))
        ->capture_default_str();
    auto runs = std::make_shared<int>(1);
    command
        ->add_option("--runs", *runs,
                     "how many runs, one after another: prints the median and the spread")
        ->check(CLI::Range(1, 100))
        ->capture_default_str();
    auto view = std::make_shared<bool>(false);
    command->add_flag("--view", *view, "draw the scene beside, as fast as the machine goes");
    add_common(*command, *options);
    command->footer(
        "\ncyclictest is in the Debian package rt-tests.\n\nExamples:\n  dihaptic bench jitter\n"
        "  dihaptic bench jitter --rate 4000 --time 10\n"
        "  dihaptic bench jitter --runs 5\n"
        "  dihaptic bench jitter --view");
    command->callback([options, time, runs, view] {
        resolve(*options);
        measure::JitterRuns all;
        {
            ProgressLine line("bench jitter");
            for (int run = 0; run < *runs && !stop_requested; ++run) {
                all.runs.push_back(
                    measure::bench_jitter(options->setup, *time, *view, stop_requested,
                                          [&](const std::string& what, double share) {
                                              line.show((run + share) / *runs, what);
                                          }));
                if (all.runs.back().ticks == 0) all.runs.pop_back();
            }
        }
        if (all.runs.empty()) {
            exit_code = kFailed;
            return;
        }
        const measure::JitterFigures& first = all.runs.front();
        if (*runs == 1) {
            fmt::print("{}", options->json ? to_json(first) : to_table(first));
        } else {
            fmt::print("{}", options->json ? to_json(all) : to_table(all));
        }
        const bool held = std::all_of(all.runs.begin(), all.runs.end(),
                                      [](const measure::JitterFigures& f) { return f.held; });
        if (stop_requested || !held) exit_code = kFailed;
    });
}

void add_view(CLI::App& bench) {
    auto* command = bench.add_subcommand(
        "view", "What a picture costs, beside the same one with a plain shadow map");
    auto json = std::make_shared<bool>(false);
    command->add_flag("--json", *json, "one JSON object on standard output, nothing else");
    command->footer("\nExample:\n  dihaptic bench view");
    command->callback([json] {
        std::vector<measure::ViewFigures> figures;
        {
            ProgressLine line("bench view");
            figures = measure::bench_view(
                60, [&](const std::string& what, double share) { line.show(share, what); });
        }
        fmt::print("{}", *json ? to_json(figures) : to_table(figures));
    });
}

}  // namespace

void add_bench(CLI::App& app) {
    auto* bench = app.add_subcommand(
        "bench", "Measure the figures that the project claims (docs/measures.md)");
    bench->require_subcommand(1);
    bench->footer("\nExample:\n  dihaptic bench grasp --json > grasp.json");
    add_grasp(*bench);
    add_friction(*bench);
    add_scale(*bench);
    add_contact(*bench);
    add_solvers(*bench);
    add_jitter(*bench);
    add_view(*bench);
}

}  // namespace dihaptic::cli
