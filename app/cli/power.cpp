#include <fmt/format.h>

#include <memory>
#include <optional>
#include <thread>

#include "command.h"
#include "python_command.h"

namespace dihaptic::cli {
namespace {

struct PowerOptions {
    std::string file;
    std::string effect;
    std::vector<int> n{8, 12, 16, 24};
    int people = 200;
    int draws = 500;
    std::string test;
    double alpha = 0.05;
    double ratio = 1;
    double attrition = 0;
    std::optional<double> smallest_effect;
    double bayes_factor = 10;
    bool sequential = false;
    std::string alternative = "two-sided";
    std::string population;
    int laboratories = 0;
    int seed = 1;
    int jobs = 0;
    std::string out;
};

/// The command line for the Python package, which parses the values of the options again.
std::vector<std::string> words_of(const PowerOptions& o) {
    std::vector<std::string> out{o.file,
                                 "--effect=" + o.effect,
                                 fmt::format("--people={}", o.people),
                                 fmt::format("--draws={}", o.draws),
                                 fmt::format("--alpha={}", o.alpha),
                                 fmt::format("--ratio={}", o.ratio),
                                 fmt::format("--attrition={}", o.attrition),
                                 fmt::format("--bayes-factor={}", o.bayes_factor),
                                 fmt::format("--laboratories={}", o.laboratories),
                                 fmt::format("--seed={}", o.seed),
                                 fmt::format("--jobs={}", o.jobs),
                                 "--test=" + o.test,
                                 "--alternative=" + o.alternative,
                                 "--population=" + o.population,
                                 "--out=" + o.out,
                                 "--n"};
    for (const int n : o.n) out.push_back(fmt::format("{}", n));
    if (o.sequential) out.push_back("--sequential");
    if (o.smallest_effect) out.push_back(fmt::format("--smallest-effect={}", *o.smallest_effect));
    return out;
}

void power(PowerOptions options) {
    if (options.jobs == 0)
        options.jobs = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
    run_python(options.file, "power", "dihaptic.power_analysis.__main__", words_of(options));
}

void add_options_of_pool(CLI::App& command, PowerOptions& options) {
    command.add_option("--people", options.people, "number of people in the pool")
        ->capture_default_str();
    command.add_option("--population", options.population,
                       "population file; default: the program's own");
    command.add_option("--laboratories", options.laboratories,
                       "number of laboratories from which the people of the pool come in turn, to "
                       "show how the power differs between laboratories; default: as many as the "
                       "population says");
    command.add_option("--seed", options.seed, "seed of the people and of the samples")
        ->capture_default_str();
    command.add_option("--jobs", options.jobs,
                       "number of people at a time; default: one on each processor");
}

void add_options_of_test(CLI::App& command, PowerOptions& options) {
    command.add_option(
        "--test", options.test,
        "t, wilcoxon, bayes or, for two groups, welch; default: t, or welch for two groups");
    command.add_option("--alpha", options.alpha, "significance level of the test")
        ->capture_default_str();
    command
        .add_option("--alternative", options.alternative,
                    "greater or less, for a one-sided test of effects above or below zero")
        ->capture_default_str();
    command
        .add_option("--bayes-factor", options.bayes_factor,
                    "Bayes factor above which the test bayes finds the effect")
        ->capture_default_str();
    command.add_flag("--sequential", options.sequential,
                     "test one study after each number of --n, and end it at the first test that "
                     "finds the effect");
}

}  // namespace

void add_power(CLI::App& app) {
    auto* command = app.add_subcommand(
        "power", "Compute the statistical power of an experiment from simulated people who do it");
    auto options = std::make_shared<PowerOptions>();
    command
        ->add_option("EXPERIMENT|FOLDER", options->file,
                     "experiment, which a pool of simulated people does first; or the folder "
                     "of a rehearsal, whose people are then the pool")
        ->required();
    command
        ->add_option("--effect", options->effect,
                     "expression over its tables: a value of each person, which is compared with "
                     "zero, or one group's value minus another's")
        ->required();
    command
        ->add_option("--n", options->n,
                     "numbers of people recruited in each group, 3 or more, separated by commas")
        ->delimiter(',')
        ->capture_default_str();
    command->add_option("--draws", options->draws, "number of samples of each size")
        ->capture_default_str();
    add_options_of_test(*command, *options);
    command
        ->add_option("--ratio", options->ratio,
                     "number of people in the second group for one in the first")
        ->capture_default_str();
    command->add_option("--attrition", options->attrition, "share of people who drop out")
        ->capture_default_str();
    command->add_option("--smallest-effect", options->smallest_effect,
                        "smallest effect of interest, in the unit of the effect, for the power to "
                        "find it among people who differ as simulated; default: the effect in the "
                        "pool");
    add_options_of_pool(*command, *options);
    command->add_option("--out", options->out, "folder of the results; default: power/NAME_SEED");
    command->footer(
        "\nA folder in it, named after the effect, gets power.html, a page for a preregistration; "
        "the "
        "figure\n"
        "power.svg, .pdf and .png; and power.csv, power-by-n.csv (power-by-look.csv of a "
        "sequential study)\n"
        "and effect-of-people.csv. The "
        "pool is in the "
        "folder\n"
        "pool: if the command is interrupted, the same command continues it.\n"
        "\nExample:\n  dihaptic power experiments/size-weight.yaml --n 8,12,16 \\\n"
        "    --effect \"mean(peak_grip_rate_N_s, condition=large) - mean(peak_grip_rate_N_s, "
        "condition=small)\"");
    command->callback([options] { power(*options); });
}

}  // namespace dihaptic::cli
