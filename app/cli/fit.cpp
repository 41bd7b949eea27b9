#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>
#include <vector>

#include "analysis/fits/parameters.h"
#include "base/table.h"
#include "command.h"

namespace dihaptic::cli {
namespace {

/// The result of a fit, printed as text or, for programs, as JSON.
struct Fitted {
    analysis::Parameters parameters;
    /// Further figures, printed with the parameters.
    std::vector<std::pair<const char*, double>> others;
    std::string note;

    std::string json() const {
        nlohmann::ordered_json out;
        for (const analysis::Parameter& p : parameters) out[p.name] = p.value;
        for (const auto& [key, value] : others) out[key] = value;
        for (const analysis::Parameter& p : parameters)
            out["intervals_95"][p.name] = {p.interval.low, p.interval.high};
        out["note"] = note;
        return out.dump(2) + "\n";
    }
    std::string text() const {
        std::string out;
        for (const analysis::Parameter& p : parameters) {
            std::string name = p.name;
            std::replace(name.begin(), name.end(), '_', ' ');
            out += fmt::format("{:16} {:10.6g}   95 %: {:.6g} to {:.6g}\n", name, p.value,
                               p.interval.low, p.interval.high);
        }
        return out + note + "\n";
    }
};

/// Reads a table from the user that must have these columns, and prints its warnings.
CsvFile given(const std::string& file, std::initializer_list<const char*> columns,
              const char* remedy) {
    Diagnostics diagnostics;
    CsvFile table = CsvFile::given(file, diagnostics, [&](const CsvFile& head) {
        for (const char* column : columns) {
            if (!head.has(column)) throw Error(head.head(), column, "does not exist", remedy);
        }
    });
    print(diagnostics.problems(), stderr);
    return table;
}

double number(const CsvFile& table, size_t row, const char* column, const char* remedy) {
    const double value = table.number(row, column);
    if (std::isfinite(value)) return value;
    throw Error(table.place(row), column,
                fmt::format("is '{}', which is not a number", table.text(row, column)), remedy);
}

/// The measured value in each trial; NaN if the cell is empty.
struct Measured {
    std::vector<double> values;
    int count = 0;  ///< number of trials with a measured value
};

/// Throws Error when fewer than `least` trials have a measured value.
Measured read_measured(const CsvFile& table, int least, const char* parameters) {
    Measured out;
    for (size_t i = 0; i < table.rows(); ++i) {
        const bool unmeasured = table.text(i, "compensation").empty();
        out.values.push_back(unmeasured ? NAN
                                        : number(table, i, "compensation",
                                                 "Leave it empty if nothing was measured."));
        out.count += unmeasured ? 0 : 1;
    }
    if (out.count < least) {
        throw Error(table.head(), "compensation",
                    fmt::format("is measured in {} trials", out.count),
                    fmt::format("{} require at least {}.", parameters, least));
    }
    return out;
}

std::vector<model::AdaptationTrial> read_trials(const CsvFile& table) {
    std::vector<model::AdaptationTrial> out;
    for (size_t i = 0; i < table.rows(); ++i) {
        const std::string clamp = table.text(i, "clamp");
        if (clamp != "0" && clamp != "1") {
            throw Error(table.place(i), "clamp", fmt::format("is '{}'", clamp),
                        "Write 1 if no error was shown, whatever the person did, and 0 otherwise.");
        }
        // in a clamp trial, nothing is learned from the perturbation
        const double perturbation = clamp == "1"
                                        ? 0
                                        : number(table, i, "perturbation",
                                                 "Write the perturbation shown, 0 for none, in one "
                                                 "unit and with the sign of the compensation.");
        out.push_back({perturbation, clamp == "1"});
    }
    return out;
}

template <class Fit>
Fitted curve(const Fit& fit, int n) {
    return {analysis::parameters(fit),
            {{"sse", fit.mean_square * n}, {"n", n}},
            fmt::format("{} trials; sum of squared residuals {:.6g}, their SD {:.4g}", n,
                        fit.mean_square * n, fit.residual_sd)};
}

constexpr const char* kTrialColumns =
    "Give the columns perturbation, clamp and compensation, with one row per trial.";

Fitted fit_two_rate(const std::string& file) {
    const CsvFile table = given(file, {"perturbation", "clamp", "compensation"}, kTrialColumns);
    const auto trials = read_trials(table);
    const Measured measured = read_measured(table, 5, "Four parameters");
    return curve(analysis::fit_two_rate(measured.values, trials), measured.count);
}

Fitted fit_single_rate(const std::string& file) {
    const CsvFile table = given(file, {"perturbation", "clamp", "compensation"}, kTrialColumns);
    const auto trials = read_trials(table);
    const Measured measured = read_measured(table, 3, "Two parameters");
    return curve(analysis::fit_single_rate(measured.values, trials), measured.count);
}

Fitted fit_learning_curve(const std::string& file) {
    const CsvFile table =
        given(file, {"compensation"}, "Give the column compensation, with one row per trial.");
    const Measured measured = read_measured(table, 4, "Three parameters");
    return curve(analysis::fit_learning_curve(measured.values), measured.count);
}

struct PsychometricOptions {
    std::string file;
    analysis::PsychometricFitSettings settings;
};

/// Reads the answers from a table whose column `yes` contains 1 or "yes", or 0 or "no".
std::vector<analysis::Answer> read_answers(const std::string& file) {
    const CsvFile table =
        given(file, {"level", "yes"},
              "Give the columns level and yes (1 or 0), with one row per answer.");
    std::vector<analysis::Answer> out;
    for (size_t i = 0; i < table.rows(); ++i) {
        const std::string yes = table.text(i, "yes");
        const bool is_yes = yes == "1" || yes == "yes";
        if (!is_yes && yes != "0" && yes != "no") {
            throw Error(table.place(i), "yes", fmt::format("is '{}'", yes),
                        "Write 1 for yes, or a correct answer, and 0 for the other answer.");
        }
        out.push_back({number(table, i, "level", "Write the level shown."), is_yes});
    }
    return out;
}

Fitted fit_psychometric(const PsychometricOptions& options) {
    const auto counts = analysis::count(read_answers(options.file));
    const analysis::PsychometricFit fit = analysis::fit_psychometric(counts, options.settings);
    const auto ends = analysis::profile_intervals(counts, fit, options.settings);
    int n = 0;
    for (const analysis::LevelCount& level : counts) n += level.trials;
    const std::string doubt = analysis::why_no_threshold(counts, fit);
    return {
        analysis::parameters(fit, ends),
        {{"guess", fit.function.guess}, {"deviance", fit.deviance}, {"n", n}},
        fmt::format("{} answers at {} levels; deviance {:.4g}{}{}", n, counts.size(), fit.deviance,
                    fit.shape_unknown ? "; the answers do not determine the shape" : "",
                    doubt.empty() ? "" : "; the threshold is " + doubt)};
}

/// Adds a command to `fit` that fits a curve to adaptation trials.
void add_curve(CLI::App& fit, const std::string& name, const std::string& what,
               const std::string& columns, Fitted (*find)(const std::string&)) {
    auto* command = fit.add_subcommand(name, what);
    auto file = std::make_shared<std::string>();
    auto json = std::make_shared<bool>(false);
    command->add_option("FILE", *file, "CSV, one row per trial: " + columns)->required();
    add_json(*command, *json);
    command->footer(fmt::format("\nExample:\n  dihaptic fit {} person.csv --json", name));
    command->callback([file, json, find] {
        const Fitted found = find(*file);
        fmt::print("{}", *json ? found.json() : found.text());
    });
}

void add_psychometric(CLI::App& fit) {
    auto* command = fit.add_subcommand(
        "psychometric", "The psychometric function that makes the answers most likely");
    auto options = std::make_shared<PsychometricOptions>();
    auto json = std::make_shared<bool>(false);
    command->add_option("FILE", options->file, "CSV, one row per answer: level, yes (1 or 0)")
        ->required();
    add_choice(*command, "--sigmoid", options->settings.sigmoid,
               "shape of the function; default: normal");
    command
        ->add_option("--guess", options->settings.guess,
                     "share of 'yes' answers expected from guessing")
        ->check(CLI::Range(0.0, 0.99))
        ->capture_default_str();
    command->add_option("--max-lapse", options->settings.max_lapse, "largest share of lapses")
        ->check(CLI::Range(0.0, 0.49))
        ->capture_default_str();
    command
        ->add_option("--shape", options->settings.shape,
                     "slope or spread of the function, if known; it must be known after an "
                     "adaptive procedure")
        ->check(CLI::PositiveNumber);
    add_json(*command, *json);
    command->footer("\nExample:\n  dihaptic fit psychometric answers.csv --guess 0 --json");
    command->callback([options, json] {
        const Fitted found = fit_psychometric(*options);
        fmt::print("{}", *json ? found.json() : found.text());
    });
}

}  // namespace

void add_fit(CLI::App& app) {
    auto* command = app.add_subcommand("fit", "Fit a model to your own table");
    command->require_subcommand(1);
    command->footer("\nExample:\n  dihaptic fit two_rate person.csv --json");
    const std::string trials = "perturbation, clamp (0 or 1), compensation (empty: not measured)";
    add_curve(
        *command, "two_rate",
        "The two-rate model of adaptation (Smith et al. 2006) that is closest to a person's trials",
        trials, fit_two_rate);
    add_curve(*command, "single_rate", "The model with a single process", trials, fit_single_rate);
    add_curve(*command, "learning_curve", "An exponential from a start to an asymptote",
              "compensation (empty: not measured)", fit_learning_curve);
    add_psychometric(*command);
}

}  // namespace dihaptic::cli
