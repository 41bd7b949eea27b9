#include <fmt/format.h>

#include "base/figure_text.h"
#include "command.h"
#include "measure/grasp.h"
#include "session/plan.h"

namespace dihaptic::cli {
namespace {

struct GraspOptions {
    measure::BenchSetup setup;
    bool any_coupling = true;
    std::vector<std::string> set;
    bool json = false;
};

/// The setup to be measured and, for the readable output, the setups to compare it with.
std::vector<measure::BenchSetup> compared(const GraspOptions& options) {
    std::vector<measure::BenchSetup> out{options.setup};
    const bool rigid = options.setup.settings.proxy.kind == scene::ProxyKind::rigid;
    if (options.json || (rigid && !options.any_coupling)) return out;
    frame::Settings& other = out.emplace_back(options.setup).settings;
    if (rigid) other.coupling.kind = frame::CouplingKind::dual_spring;
    if (!rigid) other.proxy.friction = frame::PointFriction::apart;
    return out;
}

void run_grasp(GraspOptions options) {
    for (const std::string& text : options.set)
        session::apply_setting(options.setup.settings, text);
    std::string out;
    {
        ProgressLine line("bench grasp");
        const std::vector<measure::BenchSetup> setups = compared(options);
        for (size_t i = 0; i < setups.size(); ++i) {
            const measure::GraspFigures figures =
                measure::bench_grasp(setups[i], [&](const std::string& what, double share) {
                    line.show_or_stop(
                        (static_cast<double>(i) + share) / static_cast<double>(setups.size()),
                        what);
                });
            out += (i > 0 ? "\n\n" : "") + (options.json ? to_json(figures) : figure_text(figures));
        }
    }
    fmt::print("{}", out);
}

void add_grasp(CLI::App& bench) {
    auto* command = bench.add_subcommand("grasp",
                                         "Measure how steadily and accurately two fingers lift "
                                         "and hold a block, and how stiff the coupling may be");
    auto options = std::make_shared<GraspOptions>();
    frame::Settings& settings = options->setup.settings;
    add_choice(*command, "--solver", settings.dynamics.solver, "contact solver");
    add_choice(*command, "--coupling", settings.coupling.kind, "coupling of handle and proxy");
    command->add_option("--rate", settings.rate, "ticks per second [Hz]")
        ->check(rate_range())
        ->capture_default_str();
    add_json(*command, options->json);
    add_choice(*command, "--proxy", settings.proxy.kind, "model of a finger in the world");
    command->add_option("--mass", options->setup.mass, "mass of the block [kg]")
        ->capture_default_str();
    command->add_option("--friction", options->setup.friction, "coefficient of friction")
        ->capture_default_str();
    command->add_option("--set", options->set,
                        "any other setting, e.g. coupling.onset_ms=20; may be repeated");
    command->footer(
        "\nWithout --coupling, the bench measures both couplings of rigid proxies, and also "
        "points whose\nfriction is solved either together with the dynamics or separately. With "
        "--json, it measures\nonly the default coupling.\n\nExamples:\n"
        "  dihaptic bench grasp --coupling dual_spring --mass 0.2\n"
        "  dihaptic bench grasp --set coupling.onset_ms=20");
    command->callback([command, options] {
        options->any_coupling = command->count("--coupling") == 0;
        run_grasp(*options);
    });
}

/// Developers' benchmarks are in a separate program; a user who looks for one of them here is told
/// where it is.
void add_moved(CLI::App& bench) {
    for (const char* name : {"friction", "scale", "heap", "contact", "solvers", "jitter", "view"}) {
        auto* command = bench.add_subcommand(name)->group("")->allow_extras();
        command->set_help_flag();
        command->callback([name] {
            throw Error({"bench", 0}, name, "is in a separate program",
                        fmt::format("Use dihaptic-bench {}.", name));
        });
    }
}

}  // namespace

void add_bench(CLI::App& app) {
    auto* bench =
        app.add_subcommand("bench", "Measure how calmly a block is held (docs/measures.md)");
    bench->require_subcommand(1);
    bench->footer("\nExample:\n  dihaptic bench grasp --json > grasp.json");
    add_grasp(*bench);
    add_moved(*bench);
}

}  // namespace dihaptic::cli
