#include <fmt/format.h>

#include "analysis/bids.h"
#include "command.h"

namespace dihaptic::cli {

void add_export(CLI::App& app) {
    auto* command = app.add_subcommand(
        "export", "Add a session to a BIDS data set: motion, channels, events, participant");
    struct Options {
        std::string session;
        std::string data_set;
    };
    auto options = std::make_shared<Options>();
    command->add_option("SESSION", options->session, "folder of a session")->required();
    command->add_option("--bids", options->data_set, "folder of the data set, made if need be")
        ->required();
    command->footer(
        "\nExample:\n  dihaptic export sessions/2026-11-20_101500_lift-block_S07 --bids study");
    command->callback([options] {
        const auto session = recording::SessionFolder::open(options->session);
        analysis::Exported exported;
        {
            ProgressLine line("writing motion");
            exported = analysis::export_bids(session, options->data_set,
                                             [&](double share) { line.show(share); });
        }
        print(exported.changed);
        for (const std::string& what : exported.log) fmt::print("raw.log: {}\n", what);
        fmt::print("written: {}\n", exported.folder);
    });
}

}  // namespace dihaptic::cli
