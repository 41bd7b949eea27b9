#include <fmt/format.h>

#include "base/companion.h"
#include "cli/doctor/sections.h"
#include "command.h"

namespace dihaptic::cli {
namespace {

/// Checks the sections one after the other, and prints each as soon as it has been checked.
void report() {
    std::string heading;
    bool usable = true;
    int lacking = 0;
    for (const doctor::Section& section : doctor::sections()) {
        if (section.heading != heading) {
            fmt::print("{}{}\n", heading.empty() ? "" : "\n", section.heading);
            heading = section.heading;
        }
        for (const doctor::Finding& finding : doctor::look_from_outside(section)) {
            fmt::print("{}", doctor::to_text(finding));
            if (finding.verdict != doctor::Verdict::lacks) continue;
            ++lacking;
            usable = usable && !finding.needed;
        }
        std::fflush(stdout);
        if (stop_requested) {
            exit_code = kFailed;
            return;
        }
    }
    fmt::print(
        "\n{}{}\n",
        usable ? "Sessions on simulated devices can be run here."
               : "Sessions on simulated devices cannot run here yet.",
        lacking == 0 ? "" : " The commands below an entry marked 'lacks' solve the problem.");
    if (!usable) exit_code = kFailed;
}

}  // namespace

void add_doctor(CLI::App& app) {
    auto* command = app.add_subcommand(
        "doctor", "List parts that this machine lacks for experiments, with a command for each");
    auto section = std::make_shared<std::string>();
    command->add_option("--section", *section)->group("");  // for the processes started below
    command->footer(
        "\nNothing moves, and nothing is changed. Checks real time, devices, graphics, sound, "
        "the disk\nand the parts of Dihaptic. Returns 0 if sessions on simulated devices can be "
        "run, otherwise 1.\n"
        "\nExample:\n  dihaptic doctor");
    command->callback([section] {
        tell_companion_waits(nullptr);  // the report itself names the parts that hang
        if (section->empty()) {
            report();
        } else {
            doctor::look_inside(*section);
        }
    });
}

}  // namespace dihaptic::cli
