#include <fmt/format.h>
#include <fmt/ranges.h>
#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <variant>

#include "analysis/fits/parameters.h"
#include "base/diagnostics.h"
#include "base/field.h"
#include "parts.h"

namespace py = pybind11;

namespace dihaptic::python {
namespace {

using Counts = std::vector<std::tuple<double, int, int>>;

/// The parameters of a fit, and their intervals.
py::dict to_python(const analysis::Parameters& parameters) {
    py::dict out;
    py::dict intervals;
    for (const analysis::Parameter& p : parameters) {
        out[p.name] = p.value;
        intervals[p.name] = py::make_tuple(p.interval.low, p.interval.high);
    }
    out["intervals"] = intervals;
    return out;
}

template <class Fit>
py::dict curve(const Fit& fit, const std::vector<double>& measured) {
    const auto n =
        std::count_if(measured.begin(), measured.end(), [](double x) { return std::isfinite(x); });
    py::dict out = to_python(analysis::parameters(fit));
    out["predicted"] =
        py::array_t<double>(static_cast<py::ssize_t>(fit.predicted.size()), fit.predicted.data());
    out["residual_sd"] = fit.residual_sd;
    out["sse"] = fit.mean_square * static_cast<double>(n);
    out["n"] = n;
    return out;
}

std::vector<model::AdaptationTrial> trials(const std::vector<double>& perturbation,
                                           const std::vector<bool>& clamp) {
    if (perturbation.size() != clamp.size())
        throw Error("perturbation and clamp have different lengths", "Give one of each per trial.");
    std::vector<model::AdaptationTrial> out;
    for (size_t i = 0; i < perturbation.size(); ++i) {
        if (!clamp[i] && !std::isfinite(perturbation[i])) {
            throw Error({}, "perturbation", "is not a number in a trial that is not a clamp",
                        "Give the perturbation in the trial, 0 for none.");
        }
        out.push_back({clamp[i] ? 0 : perturbation[i], clamp[i]});
    }
    const bool any = std::any_of(out.begin(), out.end(),
                                 [](const auto& trial) { return trial.perturbation != 0; });
    if (!any) {
        throw Error({}, "perturbation", "is 0 in all trials: there was nothing to learn",
                    "Give the perturbations in the trials.");
    }
    return out;
}

py::dict fit_two_rate(const std::vector<double>& measured, const std::vector<double>& perturbation,
                      const std::vector<bool>& clamp) {
    return curve(analysis::fit_two_rate(measured, trials(perturbation, clamp)), measured);
}

py::dict fit_single_rate(const std::vector<double>& measured,
                         const std::vector<double>& perturbation, const std::vector<bool>& clamp) {
    return curve(analysis::fit_single_rate(measured, trials(perturbation, clamp)), measured);
}

py::dict fit_learning_curve(const std::vector<double>& measured) {
    return curve(analysis::fit_learning_curve(measured), measured);
}

model::Sigmoid sigmoid_of(const std::string& word) {
    if (const auto named = enum_named<model::Sigmoid>(word)) return *named;
    throw Error({}, "sigmoid", "is '" + word + "'",
                fmt::format("Valid names: {}.", fmt::join(enum_names(model::Sigmoid{}), ", ")));
}

Counts count_answers(const std::vector<double>& levels, const std::vector<bool>& answers) {
    if (levels.size() != answers.size())
        throw Error("levels and answers have different lengths", "Give one answer for each level.");
    std::vector<analysis::Answer> all;
    for (size_t i = 0; i < levels.size(); ++i) all.push_back({levels[i], answers[i]});
    Counts out;
    for (const analysis::LevelCount& level : analysis::count(all))
        out.emplace_back(level.level, level.yes, level.trials);
    return out;
}

analysis::PsychometricFitSettings settings_of(const std::string& sigmoid,
                                              const std::variant<double, std::string>& guess,
                                              double max_lapse, std::optional<double> shape) {
    analysis::PsychometricFitSettings out;
    out.sigmoid = sigmoid_of(sigmoid);
    if (const double* const rate = std::get_if<double>(&guess)) {
        if (!(*rate >= 0 && *rate < 1))
            throw Error({}, "guess", "is not a probability below 1",
                        "Give 0 for yes-or-no questions.");
        out.guess = *rate;
    } else if (std::get<std::string>(guess) == "lapse") {
        out.guess_is_lapse = true;
    } else {
        throw Error({}, "guess", "is '" + std::get<std::string>(guess) + "'",
                    "Give a probability, or \"lapse\".");
    }
    if (!(max_lapse >= 0 && max_lapse < 0.5))
        throw Error({}, "max_lapse", "is not between 0 and 0.5", "Leave it out: 0.05.");
    if (shape && !(*shape > 0))
        throw Error({}, "shape", "is not positive", "Leave it out to have it fitted.");
    out.max_lapse = max_lapse;
    out.shape = shape;
    return out;
}

py::dict fit_psychometric(const Counts& counts, const std::string& sigmoid,
                          const std::variant<double, std::string>& guess, double max_lapse,
                          std::optional<double> shape) {
    const auto settings = settings_of(sigmoid, guess, max_lapse, shape);
    std::vector<analysis::LevelCount> levels;
    for (const auto& [level, yes, asked] : counts) levels.push_back({level, yes, asked});
    const analysis::PsychometricFit fit = analysis::fit_psychometric(levels, settings);
    const auto ends = analysis::profile_intervals(levels, fit, settings);
    py::dict out = to_python(analysis::parameters(fit, ends));
    out["sigmoid"] = sigmoid;
    out["guess"] = fit.function.guess;
    out["deviance"] = fit.deviance;
    out["shape_unknown"] = fit.shape_unknown;
    return out;
}

double psychometric(const std::string& sigmoid, double threshold, double shape, double guess,
                    double lapse, double level) {
    return model::Psychometric{sigmoid_of(sigmoid), threshold, shape, guess, lapse}.probability(
        level);
}

}  // namespace

void add_fits(py::module_& m) {
    m.def("fit_two_rate", &fit_two_rate);
    m.def("fit_single_rate", &fit_single_rate);
    m.def("fit_learning_curve", &fit_learning_curve);
    m.def("count_answers", &count_answers);
    m.def("fit_psychometric", &fit_psychometric);
    m.def("psychometric", &psychometric);
}

}  // namespace dihaptic::python
