// Random numbers in a task: they are drawn for each trial using the seed, frozen in trial-list.csv,
// and available to formulas by name (docs/files.md).
//
//     uniform       from + u (to - from)                          u uniform in [0, 1)
//     exponential   from - m ln(1 - u (1 - exp(-(to - from) / m)))
//                   without `to`, m is the mean distance above `from`, and the hazard is flat. With
//                   `to`, the hazard rises before the end, as in every bounded distribution
//     normal        mean + sd z, redrawn until the value lies between from and to
//     permutation   the values in random order, then in a new random order, restarted in each
//                   block: in n trials, each of k values occurs n / k times, rounded down or up
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/field_reader.h"

namespace dihaptic::task {

constexpr Field kDrawn = Field::number().within(-1e9, 1e9);

struct UniformDraw {
    double from = 0;
    double to = 1;

    template <class Visitor>
    void visit(Visitor& v) {
        v("from", from, kDrawn.required().says("Least value."));
        v("to", to, kDrawn.required().says("Greatest value."));
    }
};

struct NormalDraw {
    double mean = 0;
    double sd = 1;
    std::optional<double> from;
    std::optional<double> to;

    template <class Visitor>
    void visit(Visitor& v) {
        v("mean", mean, kDrawn.required().says("Mean of the normal distribution."));
        v("sd", sd, kDrawn.positive().at_most(1e9).required().says("Standard deviation."));
        v("from", from, kDrawn.says("Lower bound: a number below it is redrawn."));
        v("to", to, kDrawn.says("Upper bound: a number above it is redrawn."));
    }
};

struct ExponentialDraw {
    double mean = 1;  ///< mean distance above `from` that the distribution would have without `to`
    double from = 0;
    std::optional<double> to;

    template <class Visitor>
    void visit(Visitor& v) {
        v("mean", mean,
          kDrawn.positive().at_most(1e9).required().says(
              "Mean distance above 'from' if there were no 'to'."));
        v("from", from, kDrawn.says("Least value."));
        v("to", to, kDrawn.says("Greatest value; no limit if omitted."));
    }
};

/// A number or a text drawn for each trial. A number is in the unit at the end of the draw's name.
struct DrawSpec {
    std::string name;
    std::optional<UniformDraw> uniform;
    std::optional<NormalDraw> normal;
    std::optional<ExponentialDraw> exponential;
    std::vector<std::string> choice;
    /// Weights of the values in `choice`; if empty, all are equally likely.
    std::vector<double> weights;
    std::vector<std::string> permutation;
    bool participant = false;  ///< whether the value is the participant's number
    Place place;

    template <class Visitor>
    void visit(Visitor& v) {
        v("name", name,
          Field::text().required().says(
              "Name of the draw, which may end in the unit of its numbers."));
        v("uniform", uniform, says("Uniform distribution between two numbers."));
        v("normal", normal, says("Normal distribution, which may be truncated."));
        v("exponential", exponential,
          says("Exponential distribution, which may be truncated; it gives a foreperiod a flat "
               "hazard."));
        v("choice", choice, says("Random choice of one of these numbers or texts."));
        v("weights", weights,
          Field::number().within(0, 1e9).says(
              "Weight of each value in 'choice'; all are equally likely if omitted."));
        v("permutation", permutation,
          says("These numbers or texts in random order, each equally often within a block."));
        v("participant", participant,
          says("The number at the end of the participant's identifier."));
    }

    /// The values of a choice or a permutation.
    const std::vector<std::string>& values() const { return choice.empty() ? permutation : choice; }
};

/// Whether the values are texts. They are treated as numbers only if all of them are numbers.
bool are_texts(const std::vector<std::string>& values);

void check(const DrawSpec& draw, Diagnostics& diagnostics);

/// Draws a value for each trial: a number in the unit of the draw's name or, for texts, an index.
/// `blocks` gives the number of each trial's block. Values have only as many digits as a table
/// stores, so that a session resumed from its frozen list uses the same values.
std::vector<double> drawn(const DrawSpec& draw, std::span<const int> blocks, int participant,
                          uint64_t seed);

}  // namespace dihaptic::task
