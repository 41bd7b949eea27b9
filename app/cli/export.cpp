#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "analysis/bids.h"
#include "analysis/curves.h"
#include "command.h"

namespace dihaptic::cli {
namespace {

struct Options {
    std::string session;
    std::string data_set;
    std::string names;
    std::string out;
};

void tell_log(const std::vector<std::string>& wrong) {
    for (const std::string& what : wrong) fmt::print("raw.log: {}\n", what);
}

void to_bids(const recording::SessionFolder& session, const Options& options) {
    analysis::Exported exported;
    {
        ProgressLine line("writing motion");
        exported = analysis::export_bids(session, options.data_set,
                                         [&](double share) { line.show(share); });
    }
    print(exported.changed);
    tell_log(exported.log);
    fmt::print("written: {}\n", exported.folder);
}

std::vector<std::string> split(const std::string& names) {
    std::vector<std::string> out;
    for (size_t begin = 0; begin <= names.size();) {
        const size_t end = std::min(names.find(',', begin), names.size());
        const std::string name = names.substr(begin, end - begin);
        const size_t first = name.find_first_not_of(' ');
        if (first != std::string::npos)
            out.push_back(name.substr(first, name.find_last_not_of(' ') + 1 - first));
        begin = end + 1;
    }
    return out;
}

void to_csv(const recording::SessionFolder& session, const Options& options) {
    std::string file = options.out;
    if (file.empty()) {
        const auto folder = std::filesystem::canonical(session.path());
        file = folder.filename().string() + "_curves.csv";
    }
    std::vector<std::string> wrong;
    {
        ProgressLine line("writing curves");
        wrong = analysis::export_curves(session, split(options.names), file,
                                        [&](double share) { line.show(share); });
    }
    tell_log(wrong);
    fmt::print("written: {}\n", file);
}

}  // namespace

void add_export(CLI::App& app) {
    auto* command = app.add_subcommand("export",
                                       "Add a session to a BIDS data set (motion, channels, "
                                       "events, participant), or write its curves to a CSV file");
    auto options = std::make_shared<Options>();
    command->add_option("SESSION", options->session, "folder of a session")->required();
    auto* bids = command->add_option("--bids", options->data_set,
                                     "folder of the data set, created if necessary");
    auto* csv =
        command
            ->add_option("--csv", options->names,
                         "quantities with their names in docs/quantities.md, separated by commas: "
                         "a row for each tick, with its time, its trial and these, in SI units")
            ->excludes(bids);
    command->add_option("-o,--out", options->out, "the CSV file; default: SESSION_curves.csv, here")
        ->needs(csv);
    command->footer(
        "\nExamples:\n"
        "  dihaptic export sessions/2026-11-20_101500_lift-block_S07 --bids study\n"
        "  dihaptic export --csv grip_force,load_force,block.position.z "
        "sessions/2026-11-20_101500_lift-block");
    command->callback([options] {
        if (options->data_set.empty() && split(options->names).empty()) {
            throw Error("no destination is given",
                        "Add --bids FOLDER, or --csv with names of quantities.");
        }
        const auto session = recording::SessionFolder::open(options->session);
        !options->data_set.empty() ? to_bids(session, *options) : to_csv(session, *options);
    });
}

}  // namespace dihaptic::cli
