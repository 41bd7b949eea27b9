#include <fmt/format.h>

#include "command.h"
#include "recording/session.h"
#include "terminal_guide.h"

namespace dihaptic::cli {
namespace {

struct CalibrateOptions {
    std::string rig;
    std::string out;
};

void calibrate(const CalibrateOptions& options) {
    Diagnostics diagnostics;
    const rig::Rig rig =
        rig::read_rig_to_calibrate(options.rig, diagnostics, rig::NamedBy::the_operator);
    diagnostics.throw_if_errors();
    print(diagnostics.problems());
    const std::string out =
        options.out.empty() ? rig::calibration_file(rig, options.rig) : options.out;
    rig::check_calibration_file(options.rig, out);
    rig::CalibrationInput input;
    try {
        TerminalGuide guide("calibrate");
        input = rig::lead_calibration(rig, guide.guide());
    } catch (const rig::GivenUp&) {
        fmt::print(stderr, "interrupted: nothing was stored\n");
        exit_code = kFailed;
        return;
    }
    rig::CalibrationResult result = rig::calibrate(input);
    result.calibration.date = recording::iso_now().substr(0, 10);
    const std::string picture = rig::store_calibration(rig, result, out);
    fmt::print("{}\n{}picture: {}\ncalibration: {}\n", rig.title, rig::describe(result), picture,
               out);
    if (rig.calibration.empty()) {
        fmt::print("\nfor the rig file:\n\n{}\n", rig::calibration_line(options.rig, out));
    }
}

}  // namespace

void add_calibrate(CLI::App& app) {
    auto* command = app.add_subcommand(
        "calibrate",
        "Find the true poses of a rig's devices, by a link between their endpoints and a jig");
    auto options = std::make_shared<CalibrateOptions>();
    command->add_option("RIG", options->rig, "rig file, with the jig's points if a jig is used")
        ->transform(given_or_kept())
        ->required();
    command->add_option(
        "-o,--out", options->out,
        "calibration file; default: the rig's own, next to the rig file. The picture of the "
        "residuals is named after it");
    command->footer(
        "\nExample:\n  dihaptic calibrate rigs/premium-misplaced.yaml -o "
        "calibration.yaml");
    command->callback([options] { calibrate(*options); });
}

}  // namespace dihaptic::cli
