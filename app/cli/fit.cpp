#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <vector>

#include "analysis/fits/two_rate_fit.h"
#include "base/table.h"
#include "command.h"

namespace dihaptic::cli {
namespace {

/// The trials of a table, with what was measured in each.
struct Trials {
    std::vector<double> measured;
    std::vector<model::AdaptationTrial> trials;
    int count = 0;  ///< number of trials in which something was measured
};

double number(const CsvFile& table, const std::string& file, size_t row, const char* column,
              const char* remedy) {
    const double value = table.number(row, column);
    if (std::isfinite(value)) return value;
    throw Error({file, static_cast<int>(row) + 2}, column,
                fmt::format("is '{}', which is no number", table.text(row, column)), remedy);
}

Trials read_trials(const std::string& file) {
    const CsvFile table(file);
    for (const char* column : {"perturbation", "clamp", "compensation"}) {
        if (!table.has(column)) {
            throw Error({file, 1}, column, "is not there",
                        "Give the columns perturbation, clamp and compensation, a row a trial.");
        }
    }
    Trials out;
    for (size_t i = 0; i < table.rows(); ++i) {
        const std::string clamp = table.text(i, "clamp");
        if (clamp != "0" && clamp != "1") {
            throw Error({file, static_cast<int>(i) + 2}, "clamp", fmt::format("is '{}'", clamp),
                        "Write 1 where no error was shown, whatever the person did, and 0 "
                        "elsewhere.");
        }
        // in a clamp trial the perturbation is not learned from
        const double perturbation =
            clamp == "1" ? 0
                         : number(table, file, i, "perturbation",
                                  "Write what the trial showed, 0 for none, in one unit and with "
                                  "the sign of what compensates for it.");
        out.trials.push_back({perturbation, clamp == "1"});
        const bool unmeasured = table.text(i, "compensation").empty();
        out.measured.push_back(unmeasured ? NAN
                                          : number(table, file, i, "compensation",
                                                   "Leave it empty where nothing was measured."));
        out.count += unmeasured ? 0 : 1;
    }
    return out;
}

std::string to_json(const analysis::TwoRateFit& fit, int n) {
    const nlohmann::ordered_json json = {{"retention_slow", fit.rates.slow.retention},
                                         {"learning_slow", fit.rates.slow.learning},
                                         {"retention_fast", fit.rates.fast.retention},
                                         {"learning_fast", fit.rates.fast.learning},
                                         {"sse", fit.mean_square * n},
                                         {"n", n}};
    return json.dump(2) + "\n";
}

std::string to_text(const analysis::TwoRateFit& fit, int n) {
    const auto line = [](const char* name, double value, const analysis::Interval& i) {
        return fmt::format("{:16} {:8.5f}   95 %: {:.5f} to {:.5f}\n", name, value, i.low, i.high);
    };
    return line("slow retention", fit.rates.slow.retention, fit.retention_slow) +
           line("slow learning", fit.rates.slow.learning, fit.learning_slow) +
           line("fast retention", fit.rates.fast.retention, fit.retention_fast) +
           line("fast learning", fit.rates.fast.learning, fit.learning_fast) +
           fmt::format("{} trials; sum of squared residuals {:.6g}, their SD {:.4g}\n", n,
                       fit.mean_square * n, fit.residual_sd);
}

}  // namespace

void add_fit(CLI::App& app) {
    auto* command = app.add_subcommand("fit", "Fit a model to a table of one's own");
    command->require_subcommand(1);
    command->footer("\nExample:\n  dihaptic fit two_rate person.csv --json");
    auto* two_rate = command->add_subcommand("two_rate",
                                             "The two-rate model of adaptation (Smith et al. 2006) "
                                             "that is nearest to a person's trials");
    auto file = std::make_shared<std::string>();
    auto json = std::make_shared<bool>(false);
    two_rate
        ->add_option("FILE", *file,
                     "CSV, a row a trial: perturbation, clamp (0 or 1), compensation (empty: not "
                     "measured)")
        ->required();
    add_json(*two_rate, *json);
    two_rate->footer("\nExample:\n  dihaptic fit two_rate person.csv --json");
    two_rate->callback([file, json] {
        const Trials trials = read_trials(*file);
        constexpr int kLeast = 5;
        if (trials.count < kLeast) {
            throw Error({*file, 0}, "compensation",
                        fmt::format("is measured in {} trials", trials.count),
                        "Four parameters take five at least.");
        }
        const analysis::TwoRateFit fit = analysis::fit_two_rate(trials.measured, trials.trials);
        fmt::print("{}", *json ? to_json(fit, trials.count) : to_text(fit, trials.count));
    });
}

}  // namespace dihaptic::cli
