#include <fmt/format.h>

#include <array>

#include "base/companion.h"
#include "base/shell_word.h"
#include "command.h"
#include "common/steady_output.h"
#include "common/stop_signals.h"
#include "host/at_death.h"
#include "recording/session.h"

namespace dihaptic::cli {
namespace {

std::string typed;

/// Prints the first steps when the program is called without arguments. `program` is the program's
/// name as typed, so that the printed lines can be typed as they are.
void say_what_to_do(const std::string& program) {
    struct Line {
        std::string command;
        const char* what;
    };
    const std::array<Line, 5> lines{{
        {"run experiments/lift-block.yaml",
         "two fingers lift a block: prints figures, makes a recording"},
        {"gui", "the window, in which your mouse moves the hand"},
        {"new study NAME", "a study of your own, to be edited"},
        {"doctor", "parts that this machine lacks, with a command for each"},
        {"--help", "all commands; each has its own --help"},
    }};
    size_t width = 0;
    for (const Line& line : lines) width = std::max(width, line.command.size());
    fmt::print(stderr,
               "Dihaptic: a virtual tabletop for experiments with force-feedback devices, or with "
               "simulated ones.\nTo start:\n\n");
    for (const Line& line : lines)
        fmt::print(stderr, "  {} {:{}}    {}\n", program, line.command, width, line.what);
}

}  // namespace

std::string command_line() {
    return typed;
}

}  // namespace dihaptic::cli

int main(int argc, char** argv) {
    using namespace dihaptic;
    app::stop_on_signals(cli::stop_requested);
    host::take_force_away_at_death();
    cli::make_output_steady();
    tell_companion_waits([](const std::string& what, int seconds, int most) {
        fmt::print(stderr, "{}: {} s so far, {} s at most\n", what, seconds, most);
    });
    cli::typed = "dihaptic";
    for (int i = 1; i < argc; ++i) cli::typed += " " + shell_word(argv[i]);
    if (argc <= 1) {
        cli::say_what_to_do(argc == 1 ? shell_file(argv[0]) : "dihaptic");
        return cli::kBadInput;  // a script that passes empty arguments must not seem to succeed
    }

    CLI::App app(
        "Dihaptic: grasp, lift and turn virtual objects with two force-feedback devices, or with a "
        "simulated hand.");
    app.set_version_flag("--version", recording::program_version());
    app.footer(
        "\nExample:\n  dihaptic run experiments/lift-block.yaml\n\nEach command has its own "
        "--help.");
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
    cli::add_power(app);
    cli::add_report(app);
    cli::add_fit(app);
    cli::add_export(app);
    cli::add_gui(app);
    cli::add_workspace(app);
    cli::add_calibrate(app);
    cli::add_calibrate_population(app);
    cli::add_register(app);
    cli::add_participant(app);
    cli::add_new(app);
    cli::add_schema(app);
    cli::add_doctor(app);
    return cli::run_program(app, argc, argv);
}
