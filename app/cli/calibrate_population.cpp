#include <memory>

#include "command.h"
#include "python_command.h"

namespace dihaptic::cli {
namespace {

struct PopulationOptions {
    std::vector<std::string> files;
    std::string out = "population.yaml";
    bool compare = false;
};

void calibrate_population(const PopulationOptions& options) {
    std::vector<std::string> words{"--out=" + options.out};
    if (options.compare) words.emplace_back("--compare");
    words.emplace_back("--");  // files may begin with a hyphen
    words.insert(words.end(), options.files.begin(), options.files.end());
    run_python(options.files.front(), "population", "dihaptic.calibration.__main__", words);
}

}  // namespace

void add_calibrate_population(CLI::App& app) {
    auto* command =
        app.add_subcommand("calibrate-population",
                           "Fit how simulated people learn rotations to groups of real people");
    auto options = std::make_shared<PopulationOptions>();
    command
        ->add_option("CSV", options->files,
                     "the reaches of one group, i.e. of one laboratory, in each file; two or more")
        ->required();
    command->add_option("--out", options->out, "population file that is written")
        ->capture_default_str();
    command->add_flag("--compare", options->compare,
                      "also print how well other structures of learning fit, and how well each "
                      "group is predicted by the others: takes some minutes");
    command->footer(
        "\nColumns: participant, trial, rotation_deg, compensation_deg (the hand's angle to the "
        "target,\n"
        "positive if it compensates), and where they differ between trials clamp (1: the cursor "
        "moves at\n"
        "that angle whatever the hand does) and feedback (none: no cursor was seen). The table "
        "adaptation.csv\n"
        "that collect writes is read, too. The file that is written is used by --population; "
        "people from\n"
        "several laboratories come with --laboratories.\n"
        "\nExample:\n  dihaptic calibrate-population ours.csv theirs.csv --out mine.yaml\n"
        "  dihaptic rehearse experiments/rotation-reversal.yaml --population mine.yaml --people "
        "40");
    command->callback([options] { calibrate_population(*options); });
}

}  // namespace dihaptic::cli
