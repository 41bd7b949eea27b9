#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cstdio>
#include <filesystem>

#include "command.h"
#include "common/stop_signals.h"
#include "keeper/at_death.h"
#include "recording/session.h"
#include "steady_output.h"

namespace {

/// Throws an Error that names a word which is not a command: the parser would not name it.
void refuse_unknown_command(const CLI::App& app, int argc, char** argv) {
    if (argc < 2 || argv[1][0] == '-') return;
    std::vector<std::string> commands;
    for (const CLI::App* command : app.get_subcommands({})) {
        if (command->get_name() == argv[1]) return;
        commands.push_back(command->get_name());
    }
    const std::string guess = dihaptic::nearest(argv[1], commands);
    throw dihaptic::Error(fmt::format("'{}' is no command", argv[1]),
                          (guess.empty() ? fmt::format("There are {}.", fmt::join(commands, ", "))
                                         : fmt::format("Did you mean {}?", guess)) +
                              " See dihaptic --help.");
}

}  // namespace

int main(int argc, char** argv) {
    using namespace dihaptic;
    app::stop_on_signals(cli::stop_requested);
    keeper::take_force_away_at_death();
    cli::make_output_steady();
    cli::remember_command_line(argc, argv);

    CLI::App app(
        "Dihaptic: grasp, lift and turn virtual objects with two force-feedback devices, or with a "
        "simulated hand.");
    app.set_version_flag("--version", recording::program_version());
    app.require_subcommand(1);
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
    try {
        refuse_unknown_command(app, argc, argv);
        app.parse(argc, argv);
    } catch (const CLI::ParseError& e) {
        const int code = app.exit(e);
        return code == 0 ? cli::kOk : cli::kBadInput;
    } catch (const Error& e) {
        fmt::print(stderr, "{}\n", e.what());
        return cli::kBadInput;
    } catch (const std::filesystem::filesystem_error& e) {
        fmt::print(stderr, "{}: error: {}. Check what is there, and its permissions.\n",
                   e.path1().string(), e.code().message());
        return cli::kBadInput;
    } catch (const std::exception& e) {
        fmt::print(stderr, "error: {}. Please report this, with the command that you typed.\n",
                   e.what());
        return cli::kFailed;
    }
    return cli::exit_code;
}
