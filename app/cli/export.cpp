#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <fstream>

#include "analysis/bids.h"
#include "analysis/curves.h"
#include "command.h"
#include "common/output_file.h"
#include "study_export.h"

namespace dihaptic::cli {
namespace {

struct Options {
    std::string session;
    std::string data_set;
    std::string psych_ds;
    std::string names;
    std::string out;
    StudyData study;  ///< exported instead of a session, if SESSION is a study
};

void tell_log(const std::vector<std::string>& wrong) {
    for (const std::string& what : wrong) fmt::print("raw.log: {}\n", what);
}

void to_bids(const recording::SessionFolder& session, const Options& options) {
    analysis::Exported exported;
    {
        ProgressLine line("writing motion");
        exported = analysis::export_bids(session, options.data_set,
                                         [&](double share) { line.show_or_stop(share); });
    }
    print(exported.changed);
    tell_log(exported.log);
    fmt::print("written: {}\n", exported.folder);
}

void to_study(Options options) {
    options.study.file = options.session;
    if (!options.names.empty())
        throw Error({options.session, 0}, "--csv", "writes the curves of one session, not a study",
                    "Name the folder of a session.");
    if (!options.psych_ds.empty()) return export_psych_ds(options.study, options.psych_ds);
    if (options.study.reveal_groups)
        throw Error({options.session, 0}, "--reveal-groups", "applies to --psych-ds only",
                    "Leave it out: BIDS gets what the recordings contain.");
    export_bids(options.study, options.data_set);
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

/// Throws Error for an existing file that is not a table of curves, which nobody wants replaced.
void check_curves(const std::string& file) {
    std::string begin(analysis::kBeginOfCurves.size(), '\0');
    std::ifstream in(file, std::ios::binary);
    if (!in.is_open()) return;
    in.read(begin.data(), static_cast<std::streamsize>(begin.size()));
    if (in.gcount() == 0 || begin == analysis::kBeginOfCurves) return;
    throw Error({file, 0}, "", "exists, and is not a table of curves", "Name another file.");
}

void to_csv(const recording::SessionFolder& session, const Options& options) {
    std::string file = options.out;
    if (file.empty()) {
        const auto folder = std::filesystem::canonical(session.path());
        file = folder.filename().string() + "_curves.csv";
    }
    app::check_output_file(file, session.path(), "the session's folder", ".csv");
    check_curves(file);
    std::vector<std::string> wrong;
    {
        ProgressLine line("writing curves");
        wrong = analysis::export_curves(session, split(options.names), file,
                                        [&](double share) { line.show_or_stop(share); });
    }
    tell_log(wrong);
    fmt::print("written: {}\n", file);
}

}  // namespace

void add_export(CLI::App& app) {
    auto* command = app.add_subcommand(
        "export",
        "Add a session, or all of a study, to a BIDS data set (motion, channels, events, "
        "participant); write a study's tables as Psych-DS, or a session's curves to a CSV file");
    auto options = std::make_shared<Options>();
    command->add_option("SESSION", options->session, "folder of a session, or a study's file")
        ->required();
    auto* bids = command->add_option("--bids", options->data_set,
                                     "folder of the data set, created if necessary");
    auto* csv =
        command
            ->add_option("--csv", options->names,
                         "quantities, by their names in docs/quantities.md, separated by commas: "
                         "one row per tick, with its time, its trial and these quantities, in SI "
                         "units")
            ->excludes(bids);
    command
        ->add_option("--psych-ds", options->psych_ds,
                     "new folder for the tables of a study, with a description of each column")
        ->excludes(bids)
        ->excludes(csv);
    command->add_option("--rehearsed", options->study.rehearsed,
                        "with a study: the folder of its rehearsal, in place of its participants");
    command->add_flag("--reveal-groups", options->study.reveal_groups,
                      "with --psych-ds: show the names of concealed groups; this is logged");
    command
        ->add_option("-o,--out", options->out,
                     "the CSV file; default: SESSION_curves.csv, in this folder")
        ->needs(csv);
    command->footer(
        "\nExamples:\n"
        "  dihaptic export sessions/2026-11-20_101500_lift-block_S07 --bids study\n"
        "  dihaptic export my-study.yaml --bids study\n"
        "  dihaptic export my-study.yaml --psych-ds tables-to-share\n"
        "  dihaptic export --csv grip_force,load_force,block.position.z "
        "sessions/2026-11-20_101500_lift-block");
    command->callback([options] {
        if (options->data_set.empty() && options->psych_ds.empty() &&
            split(options->names).empty()) {
            throw Error("no destination is given",
                        "Add --bids FOLDER, --psych-ds FOLDER, or --csv with names of quantities.");
        }
        if (is_study(options->session)) return to_study(*options);
        if (!options->psych_ds.empty() || !options->study.rehearsed.empty() ||
            options->study.reveal_groups)
            throw Error({options->session, 0}, "", "is not a study's file",
                        "Name a study, or leave out --psych-ds, --rehearsed and --reveal-groups.");
        const auto session = recording::SessionFolder::open(options->session);
        !options->data_set.empty() ? to_bids(session, *options) : to_csv(session, *options);
    });
}

}  // namespace dihaptic::cli
