#include "command.h"
#include "common/steady_output.h"
#include "common/stop_signals.h"
#include "keeper/at_death.h"
#include "recording/session.h"

namespace dihaptic::cli {
namespace {

std::string typed;

}  // namespace

std::string command_line() {
    return typed;
}

}  // namespace dihaptic::cli

int main(int argc, char** argv) {
    using namespace dihaptic;
    app::stop_on_signals(cli::stop_requested);
    keeper::take_force_away_at_death();
    cli::make_output_steady();
    cli::typed = "dihaptic";
    for (int i = 1; i < argc; ++i) cli::typed += std::string(" ") + argv[i];

    CLI::App app(
        "Dihaptic: grasp, lift and turn virtual objects with two force-feedback devices, or with a "
        "simulated hand.");
    app.set_version_flag("--version", recording::program_version());
    app.footer(
        "\nExample:\n  dihaptic run experiments/lift-block.yaml\n\nEach command has --help of its "
        "own.");
    cli::add_run(app);
    cli::add_replay(app);
    cli::add_recover(app);
    cli::add_resume(app);
    cli::add_rehearse(app);
    cli::add_collect(app);
    cli::add_check(app);
    cli::add_devices(app);
    cli::add_bench(app);
    cli::add_tune(app);
    cli::add_picture(app);
    cli::add_video(app);
    cli::add_report(app);
    cli::add_fit(app);
    cli::add_export(app);
    cli::add_gui(app);
    cli::add_workspace(app);
    cli::add_calibrate(app);
    cli::add_register(app);
    return cli::run_program(app, argc, argv);
}
