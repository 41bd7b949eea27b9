#include <fmt/format.h>

#include <algorithm>

#include "command.h"
#include "session/check.h"

namespace dihaptic::cli {

void add_check(CLI::App& app) {
    auto* command = app.add_subcommand(
        "check",
        "Check scene, rig, experiment, movement and population files before a session begins");
    auto files = std::make_shared<std::vector<std::string>>();
    command->add_option("FILE", *files, "files to check")->transform(given_or_kept())->required();
    auto rig = std::make_shared<std::string>();
    command->add_option("--rig", *rig, "rig file, in place of those that the experiments name")
        ->transform(given_or_kept());
    command->footer(
        "\nExamples:\n  dihaptic check scenes/*.yaml rigs/*.yaml experiments/*.yaml "
        "movements/*.csv populations/*.yaml\n  dihaptic check experiments/grip-and-lift.yaml --rig "
        "rigs/premium-pair.yaml    limits of this rig");
    command->callback([files, rig] {
        size_t bad = 0;
        for (const std::string& file : *files) {
            Diagnostics diagnostics;
            const session::Checked checked = session::check_file(file, diagnostics, *rig);
            print(diagnostics.problems(), stdout);
            const auto warnings =
                std::count_if(diagnostics.problems().begin(), diagnostics.problems().end(),
                              [](const Problem& p) { return p.severity == Severity::warning; });
            if (diagnostics.has_errors()) {
                ++bad;
                fmt::print("{}: not usable\n", file);
            } else if (warnings > 0) {
                fmt::print("{}: {} with {} warning{}\n", file, checked.what, warnings,
                           warnings == 1 ? "" : "s");
            } else {
                fmt::print("{}: valid {}\n", file, checked.what);
            }
            for (const std::string& limit : checked.limits) fmt::print("  {}\n", limit);
        }
        if (bad > 0) exit_code = kBadInput;
    });
}

}  // namespace dihaptic::cli
