// Random numbers of a task: they are drawn for each trial from the seed, frozen in trial-list.csv,
// and available to formulas by name (docs/files.md).
//
//     uniform       from + u (to - from)                          u uniform in [0, 1)
//     exponential   from - m ln(1 - u (1 - exp(-(to - from) / m)))
//                   m is the mean above `from` if there is no `to`; the hazard is then flat. With
//                   `to` it rises before the end, like that of every bounded distribution
//     normal        mean + sd z, drawn again until it lies between from and to
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
    double mean = 1;  ///< mean distance above `from` if there were no `to`
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

/// A number or a text for each trial, in the unit at the end of its name.
struct DrawSpec {
    std::string name;
    std::optional<UniformDraw> uniform;
    std::optional<NormalDraw> normal;
    std::optional<ExponentialDraw> exponential;
    std::vector<std::string> choice;
    std::vector<double> weights;  ///< of the values in `choice`; empty: all equally likely
    std::vector<std::string> permutation;
    bool participant = false;  ///< the value is the participant's number
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

/// Whether these values are texts: they are treated as numbers only if all of them are numbers.
bool are_texts(const std::vector<std::string>& values);

void check(const DrawSpec& draw, Diagnostics& diagnostics);

/// A value for each trial, in the unit of the draw's name; for texts, their index. `blocks`: number
/// of each trial's block. Values have only the digits that a table stores, so that a session
/// resumed from its frozen list uses the same values.
std::vector<double> drawn(const DrawSpec& draw, std::span<const int> blocks, int participant,
                          uint64_t seed);

}  // namespace dihaptic::task
