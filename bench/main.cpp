// Measurements for developers of Dihaptic: solvers, ticks, threads and pictures.
// docs/measures.md defines the figures. `dihaptic` has the benches for labs.
#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "base/figure_text.h"
#include "bench/chain.h"
#include "bench/contact.h"
#include "bench/friction.h"
#include "bench/heap.h"
#include "bench/jitter.h"
#include "bench/mechanics.h"
#include "bench/public_tests.h"
#include "bench/scale.h"
#include "bench/scrub.h"
#include "bench/solvers.h"
#include "bench/task.h"
#include "bench/view.h"
#include "common/console.h"
#include "common/steady_output.h"
#include "common/stop_signals.h"
#include "recording/session.h"

namespace dihaptic::cli {
namespace {

struct BenchOptions {
    measure::BenchSetup setup;
    contact::Solver solver{};
    bool json = false;
};

std::string json_of(const auto& figures) {
    return FigureJson<nlohmann::ordered_json>::of(figures).dump(2) + "\n";
}

/// Prints rows of figures; in JSON, as a list with that name in an object.
template <class Figures>
void print_rows(const char* name, const std::vector<Figures>& rows, bool json) {
    const auto all = FigureJson<nlohmann::ordered_json>::of(rows);
    fmt::print("{}", json ? nlohmann::ordered_json{{name, all}}.dump(2) + "\n"
                          : to_text(figure_table<Figures>(rows)));
}

void add_settings(CLI::App& command, BenchOptions& options) {
    frame::Settings& settings = options.setup.settings;
    add_choice(command, "--solver", settings.dynamics.solver, "contact solver");
    add_choice(command, "--coupling", settings.coupling.kind, "coupling of handle and proxy");
    command.add_option("--rate", settings.rate, "ticks per second [Hz]")
        ->check(rate_range())
        ->capture_default_str();
    add_json(command, options.json);
}

/// Figures of each of our solvers, or of the one given, and of the peers; prints them as rows.
template <class Figures>
void print_all_solvers(const std::string& bench, const CLI::App& command,
                       const BenchOptions& options,
                       Figures (*ours)(const frame::DynamicsSettings&, const measure::Progress&),
                       Figures (*of_peer)(const bench::Simulator&, const measure::Progress&)) {
    std::vector<contact::Solver> solvers{options.solver};
    std::vector<bench::Simulator> peers;
    if (command.count("--solver") == 0) {
        solvers.clear();
        for (int i = 0; i < contact::kSolvers; ++i)
            solvers.push_back(static_cast<contact::Solver>(i));
        peers = bench::peer_simulators();
    }
    std::vector<Figures> figures;
    {
        ProgressLine line("bench " + bench);
        const auto say = [&](std::string_view name) {
            const auto done = static_cast<double>(figures.size());
            const auto all = static_cast<double>(solvers.size() + peers.size());
            return [&line, name, done, all](const std::string& what, double share) {
                line.show((done + share) / all, fmt::format("{}, {}", name, what));
            };
        };
        for (const contact::Solver solver : solvers) {
            frame::DynamicsSettings settings;
            settings.solver = solver;
            figures.push_back(ours(settings, say(enum_name(solver))));
        }
        for (const bench::Simulator& peer : peers) figures.push_back(of_peer(peer, say(peer.name)));
    }
    print_rows("solvers", figures, options.json);
}

void add_friction(CLI::App& app) {
    auto* command = app.add_subcommand(
        "friction", "Inclines, a stack, a house of cards, an arch, and a held block's creep");
    auto options = std::make_shared<BenchOptions>();
    add_choice(*command, "--solver", options->solver, "only this one; otherwise all, and peers");
    add_json(*command, options->json);
    command->footer("\nExample:\n  dihaptic-bench friction");
    command->callback([command, options] {
        print_all_solvers("friction", *command, *options, &bench::bench_friction,
                          &bench::bench_peer_friction);
    });
}

void add_public(CLI::App& app) {
    auto* command = app.add_subcommand(
        "public", "Tests of holding that users of other simulators have published");
    auto options = std::make_shared<BenchOptions>();
    add_choice(*command, "--solver", options->solver, "only this one; otherwise all, and peers");
    add_json(*command, options->json);
    command->footer("\nExample:\n  dihaptic-bench public");
    command->callback([command, options] {
        print_all_solvers("public", *command, *options, &bench::bench_public,
                          &bench::bench_peer_public);
    });
}

void add_scale(CLI::App& app) {
    auto* command =
        app.add_subcommand("scale", "Cost of a tick with 0 to 1000 more blocks on the table");
    auto options = std::make_shared<BenchOptions>();
    // the bare step that ticks are compared with is Bullet's
    options->setup.settings.dynamics.solver = contact::Solver::sequential_impulse;
    auto extras = std::make_shared<std::vector<int>>(std::vector<int>{0, 10, 50, 200, 1000});
    add_settings(*command, *options);
    command->add_option("--extra", *extras, "numbers of extra blocks")->capture_default_str();
    command->footer("\nExample:\n  dihaptic-bench scale --extra 0 10 50");
    command->callback([options, extras] {
        const auto figures = with_progress("bench scale", [&](const measure::Progress& progress) {
            return bench::bench_scale(options->setup, *extras, progress);
        });
        print_rows("tick", figures, options->json);
    });
}

void add_heap(CLI::App& app) {
    auto* command =
        app.add_subcommand("heap", "Effect of a heap beside a held block on exactness and time");
    auto options = std::make_shared<BenchOptions>();
    auto loose = std::make_shared<std::vector<int>>(std::vector<int>{20, 60, 200});
    add_settings(*command, *options);
    command->add_option("--loose", *loose, "numbers of boxes and balls")->capture_default_str();
    command->footer("\nExample:\n  dihaptic-bench heap --loose 20");
    command->callback([options, loose] {
        const auto figures = with_progress("bench heap", [&](const measure::Progress& progress) {
            return bench::bench_heap(options->setup, *loose, progress);
        });
        print_rows("heap", figures, options->json);
    });
}

void add_contact(CLI::App& app) {
    struct ContactOptions {
        std::vector<std::string> files;
        contact::Solver solver{};
        bench::ContactBench wanted;
        bool json = false;
    };
    auto* command = app.add_subcommand(
        "contact", "Contact problems from files: residual, time and iterations of each solver");
    auto options = std::make_shared<ContactOptions>();
    command
        ->add_option("files", options->files,
                     "contact problems in the FCLIB layout (HDF5), or folders of *.hdf5")
        ->required();
    add_choice(*command, "--solver", options->solver,
               "only this one; otherwise all, and the installed peers");
    command
        ->add_option("--directions", options->wanted.polygon.directions,
                     "directions of stewart_trinkle's friction polygon")
        ->check(CLI::Range(4, contact::kMostDirections))
        ->capture_default_str();
    add_choice(*command, "--direction-frame", options->wanted.polygon.frame,
               "their placement; sliding: the first along each contact's friction");
    add_json(*command, options->json);
    command->footer(
        "\nExample:\n  dihaptic-bench contact ../shared/data/contact-problems --solver newton");
    command->callback([command, options] {
        bench::ContactBench& wanted = options->wanted;
        if (command->count("--solver") > 0) {
            wanted.solvers = {options->solver};
            wanted.peers = false;
        }
        Diagnostics diagnostics;
        const auto figures = with_progress("bench contact", [&](const measure::Progress& progress) {
            return bench::bench_contact(bench::contact_files(options->files, diagnostics), wanted,
                                        diagnostics, progress);
        });
        if (options->json || !figures.empty()) print_rows("problems", figures, options->json);
        print(diagnostics.problems());
        if (diagnostics.has_errors()) exit_code = kBadInput;
    });
}

void add_solvers(CLI::App& app) {
    auto* command = app.add_subcommand("solvers",
                                       "Cost of a solve by number of contacts, compared with "
                                       "Bullet, on problems from shaken scenes");
    auto options = std::make_shared<BenchOptions>();
    add_choice(*command, "--solver", options->solver, "only this one, compared with Bullet's");
    add_json(*command, options->json);
    command->footer("\nExample:\n  dihaptic-bench solvers --solver newton");
    command->callback([command, options] {
        bench::SolversBench wanted;
        if (command->count("--solver") > 0) {
            wanted.solvers = {options->solver};
        }
        const auto figures = with_progress("bench solvers", [&](const measure::Progress& progress) {
            return bench::bench_solvers(wanted, progress);
        });
        fmt::print("{}", options->json ? json_of(figures) : figure_text(figures));
    });
}

struct JitterOptions : BenchOptions {
    double time = 60;
    int runs = 1;
    bench::Beside beside;
};

void run_jitter(const JitterOptions& options) {
    bench::JitterRuns all;
    {
        ProgressLine line("bench jitter");
        for (int run = 0; run < options.runs && !stop_requested; ++run) {
            all.runs.push_back(
                bench::bench_jitter(options.setup, options.time, options.beside, stop_requested,
                                    [&](const std::string& what, double share) {
                                        line.show((run + share) / options.runs, what);
                                    }));
            if (all.runs.back().ticks == 0) all.runs.pop_back();
        }
    }
    if (all.runs.empty()) {
        exit_code = kFailed;
        return;
    }
    if (options.runs == 1) {
        const bench::JitterFigures& only = all.runs.front();
        fmt::print("{}", options.json ? json_of(only) : to_text(only));
    } else {
        fmt::print("{}", options.json ? json_of(all) : to_text(all));
    }
    const bool held = std::all_of(all.runs.begin(), all.runs.end(),
                                  [](const bench::JitterFigures& f) { return f.held; });
    if (stop_requested || !held) exit_code = kFailed;
}

void add_jitter(CLI::App& app) {
    auto* command = app.add_subcommand(
        "jitter",
        "Punctuality of the real-time thread, compared with cyclictest, and duration of ticks");
    auto options = std::make_shared<JitterOptions>();
    command
        ->add_option("--time", options->time, "in real time, and the same again for cyclictest [s]")
        ->check(time_range())
        ->capture_default_str();
    command
        ->add_option("--extra", options->setup.extra_blocks, "more blocks on the table, kept awake")
        ->check(CLI::Range(0, 1000))
        ->capture_default_str();
    command
        ->add_option("--runs", options->runs,
                     "number of successive runs: prints the median and the spread")
        ->check(CLI::Range(1, 100))
        ->capture_default_str();
    command->add_flag("--view", options->beside.view,
                      "also draw the scene, as fast as the machine can");
    add_choice(*command, "--sound", options->beside.sound,
               "output for an additional tone, twenty times per second");
    add_settings(*command, *options);
    command->footer(
        "\ncyclictest is in the Debian package rt-tests.\n\nExamples:\n  dihaptic-bench jitter\n"
        "  dihaptic-bench jitter --rate 4000 --time 10\n"
        "  dihaptic-bench jitter --runs 5\n"
        "  dihaptic-bench jitter --view\n"
        "  dihaptic-bench jitter --sound file");
    command->callback([options] { run_jitter(*options); });
}

void add_task(CLI::App& app) {
    auto* command = app.add_subcommand(
        "task",
        "Time that a task with 20 states and 10 loads adds to a tick, and cost of 20 conditions");
    auto options = std::make_shared<BenchOptions>();
    auto pairs = std::make_shared<int>(5);
    command->add_option("--pairs", *pairs, "number of pairs of runs with and without the task")
        ->check(CLI::Range(1, 100))
        ->capture_default_str();
    add_settings(*command, *options);
    command->footer("\nExample:\n  dihaptic-bench task");
    command->callback([options, pairs] {
        const auto figures = with_progress("bench task", [&](const measure::Progress& progress) {
            return bench::bench_task(options->setup, *pairs, progress);
        });
        fmt::print("{}", options->json ? json_of(figures) : figure_text(figures));
    });
}

void add_mechanics(CLI::App& app) {
    auto* command = app.add_subcommand(
        "mechanics",
        "Pendulums, springs, linkages, bounces and soft surfaces against closed forms");
    auto options = std::make_shared<BenchOptions>();
    add_choice(*command, "--solver", options->solver, "only this one; otherwise all");
    add_json(*command, options->json);
    command->footer("\nExample:\n  dihaptic-bench mechanics --solver newton");
    command->callback([command, options] {
        std::vector<bench::MechanicsFigures> figures;
        {
            ProgressLine line("bench mechanics");
            const bool all = command->count("--solver") == 0;
            const int solvers = all ? contact::kSolvers : 1;
            for (int i = 0; i < solvers; ++i) {
                const auto solver = all ? static_cast<contact::Solver>(i) : options->solver;
                figures.push_back(
                    bench::bench_mechanics(solver, [&](const std::string& what, double share) {
                        line.show((i + share) / solvers,
                                  fmt::format("{}, {}", enum_name(solver), what));
                    }));
            }
        }
        print_rows("solvers", figures, options->json);
    });
}

void add_chain(CLI::App& app) {
    auto* command = app.add_subcommand(
        "chain",
        "Chains of 2 to 50 links on hinges: cost and exactness, compared with other simulators");
    auto options = std::make_shared<BenchOptions>();
    auto links = std::make_shared<std::vector<int>>(std::vector{2, 10, 50});
    add_choice(*command, "--solver", options->solver, "only this one and the peers; otherwise all");
    command->add_option("--links", *links, "numbers of links")
        ->delimiter(',')
        ->check(CLI::Range(1, 200))
        ->capture_default_str();
    add_json(*command, options->json);
    command->footer("\nExample:\n  dihaptic-bench chain --solver newton");
    command->callback([command, options, links] {
        std::vector<bench::Simulator> simulators;
        for (int i = 0; i < contact::kSolvers; ++i) {
            frame::DynamicsSettings settings;
            settings.solver = static_cast<contact::Solver>(i);
            if (command->count("--solver") == 0 || settings.solver == options->solver)
                simulators.push_back(bench::world_simulator(settings));
        }
        for (bench::Simulator& peer : bench::jointed_peers()) simulators.push_back(std::move(peer));
        const auto figures = with_progress("bench chain", [&](const measure::Progress& progress) {
            return bench::bench_chain(simulators, *links, progress);
        });
        print_rows("chains", figures, options->json);
    });
}

void add_scrub(CLI::App& app) {
    auto* command =
        app.add_subcommand("scrub", "Time for a jump to any moment of a recorded session");
    auto session = std::make_shared<std::string>();
    auto json = std::make_shared<bool>(false);
    command->add_option("SESSION", *session, "folder of a session")->required();
    add_json(*command, *json);
    command->footer("\nExample:\n  dihaptic-bench scrub sessions/2026-11-20_101500_lift-block");
    command->callback([session, json] {
        const auto figures = with_progress("bench scrub", [&](const measure::Progress& progress) {
            return bench::bench_scrub(*session, progress);
        });
        fmt::print("{}", *json ? json_of(figures) : figure_text(figures));
    });
}

void add_view(CLI::App& app) {
    auto* command =
        app.add_subcommand("view", "Cost of a picture, compared with one with a plain shadow map");
    auto json = std::make_shared<bool>(false);
    add_json(*command, *json);
    command->footer("\nExample:\n  dihaptic-bench view");
    command->callback([json] {
        const auto figures = with_progress("bench view", [](const measure::Progress& progress) {
            return bench::bench_view(60, progress);
        });
        fmt::print("{}", *json ? json_of(figures) : figure_text(figures));
    });
}

}  // namespace
}  // namespace dihaptic::cli

int main(int argc, char** argv) {
    using namespace dihaptic;
    app::stop_on_signals(cli::stop_requested);
    cli::make_output_steady();

    CLI::App app("Measures Dihaptic's solvers, ticks, threads and pictures (docs/measures.md).");
    app.set_version_flag("--version", recording::program_version());
    app.footer(
        "\nExample:\n  dihaptic-bench scale --json > scale.json\n\nEach command has its own --help"
        "own. dihaptic bench grasp measures how calmly a block is held.");
    cli::add_friction(app);
    cli::add_public(app);
    cli::add_scale(app);
    cli::add_heap(app);
    cli::add_contact(app);
    cli::add_solvers(app);
    cli::add_jitter(app);
    cli::add_task(app);
    cli::add_mechanics(app);
    cli::add_chain(app);
    cli::add_scrub(app);
    cli::add_view(app);
    return cli::run_program(app, argc, argv);
}
