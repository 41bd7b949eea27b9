#include "measure/tune.h"

#include <fmt/format.h>

#include "base/text_file.h"
#include "command.h"
#include "common/output_file.h"
#include "session/plan.h"

namespace dihaptic::cli {
namespace {

struct TuneOptions {
    session::Request request;
    std::string coupling;
    std::string map = "tune.svg";
    bool json = false;
};

void run(TuneOptions options) {
    if (!options.coupling.empty())
        options.request.set.push_back("coupling.kind=" + options.coupling);
    if (session::on_real_devices(options.request)) {
        throw Error({options.request.file, 0}, "rig",
                    "has real devices, but tune shakes only simulated ones",
                    "Add --rig with similar simulated devices, e.g. rigs/premium-pair.yaml.");
    }
    const session::Plan plan = session::make_plan(options.request);
    const measure::TuneSetup setup = measure::tune_setup(plan.rig, scene::finger_names(plan.scene),
                                                         plan.settings, plan.hand.impedance);
    // reported before a minute of computation, not after it
    app::check_output_file(options.map, options.request.file, "the file to be tuned", ".svg");
    const auto result = with_progress("tune", [&](const measure::Progress& progress) {
        return measure::tune(setup, stop_requested, progress);
    });
    if (result.interrupted) throw Interrupted{};
    write_file(measure::tune_map(result, setup, plan.rig.title), options.map);
    if (options.json) {
        fmt::print("{}", to_json(result, setup));
    } else {
        fmt::print("{}\n{}", plan.rig.title, to_table(result, setup));
        fmt::print("\nmap: {}\n", options.map);
        if (result.proposal)
            fmt::print("\nfor the rig, the scene or the experiment:\n\n{}",
                       settings_block(result, setup));
    }
    if (!result.proposal) exit_code = kFailed;
}

}  // namespace

void add_tune(CLI::App& app) {
    auto* command = app.add_subcommand(
        "tune", "Find the stiffest coupling that stays calm on a device, in a hand");
    auto options = std::make_shared<TuneOptions>();
    command
        ->add_option("FILE", options->request.file,
                     "scene or experiment: its rig, hand and settings, as in dihaptic run")
        ->transform(given_or_kept())
        ->required();
    command
        ->add_option("--rig", options->request.rig,
                     "rig file with simulated devices, in place of the experiment's")
        ->transform(given_or_kept());
    command->add_option("--coupling", options->coupling,
                        "coupling of handle and proxy: implicit, dual_spring, velocity_impulse");
    command->add_option("--set", options->request.set,
                        "any other setting, e.g. rate_Hz=2000; may be repeated");
    command->add_option("--map", options->map, "picture of calm and shaking settings (SVG)")
        ->capture_default_str();
    add_json(*command, options->json);
    command->footer(
        "\nA simulated hand holds a block at each stiffness and damping, also under harder "
        "conditions: one more tick of\ndelay, a block of 10 g, a loose and a firm hand. It takes "
        "about a minute.\n\nExamples:\n  dihaptic tune experiments/lift-block.yaml\n  dihaptic "
        "tune "
        "scenes/block-on-table.yaml --rig rigs/premium-pair.yaml --map premium.svg");
    command->callback([options] { run(*options); });
}

}  // namespace dihaptic::cli
