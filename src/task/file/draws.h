// Random numbers of a task: each trial has its own, drawn from the seed and frozen in
// trial-list.csv. Formulas name them (docs/files.md).
//
//     uniform       from + u (to - from)                          u uniform in [0, 1)
//     exponential   from - m ln(1 - u (1 - exp(-(to - from) / m)))
//                   m is the mean above `from` without a `to`; the hazard is then flat, and with
//                   one rises before it, as of every distribution that ends
//     normal        mean + sd z, drawn again until it lies between from and to
//     permutation   the values in an order by chance, and then in another, anew in each block: in
//                   n trials each of k values comes n / k times, or once more
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
        v("sd", sd, kDrawn.positive().at_most(1e9).required().says("Its standard deviation."));
        v("from", from, kDrawn.says("Least value: below it, the number is drawn again."));
        v("to", to, kDrawn.says("Greatest value: above it, the number is drawn again."));
    }
};

struct ExponentialDraw {
    double mean = 1;  ///< above `from`, if there were no `to`
    double from = 0;
    std::optional<double> to;

    template <class Visitor>
    void visit(Visitor& v) {
        v("mean", mean,
          kDrawn.positive().at_most(1e9).required().says(
              "Mean of what is above from, if there were no to."));
        v("from", from, kDrawn.says("Least value."));
        v("to", to, kDrawn.says("Greatest value; left out, there is none."));
    }
};

/// A number or a text of each trial; in the unit that its name ends in.
struct DrawSpec {
    std::string name;
    std::optional<UniformDraw> uniform;
    std::optional<NormalDraw> normal;
    std::optional<ExponentialDraw> exponential;
    std::vector<std::string> choice;
    std::vector<double> weights;  ///< of the choice's values; empty: all are as likely
    std::vector<std::string> permutation;
    bool participant = false;  ///< the participant's number
    Place place;

    template <class Visitor>
    void visit(Visitor& v) {
        v("name", name,
          Field::text().required().says(
              "Name of the draw, which may end in the unit of its numbers."));
        v("uniform", uniform, says("Each number between two is as likely."));
        v("normal", normal, says("A normal distribution, which may be cut."));
        v("exponential", exponential,
          says("An exponential distribution, which may be cut: of a foreperiod, the "
               "hazard is flat."));
        v("choice", choice, says("One of these numbers or texts."));
        v("weights", weights,
          Field::number().within(0, 1e9).says(
              "Weight of each value of the choice; left out, all are as likely."));
        v("permutation", permutation,
          says("These numbers or texts in random order, each equally often within a block."));
        v("participant", participant, says("The number that ends the participant's identifier."));
        if constexpr (requires { v.place(); }) place = v.place();
    }

    /// The values of a choice or a permutation.
    const std::vector<std::string>& values() const { return choice.empty() ? permutation : choice; }
};

/// Whether these values are texts: they are numbers if all of them are.
bool are_texts(const std::vector<std::string>& values);

void check(const DrawSpec& draw, Diagnostics& diagnostics);

/// A value for each trial, in the unit of the draw's name; of texts, their index. `blocks`: number
/// of each trial's block. They have the digits that a table has, so that a session that goes on
/// from its frozen list has the same.
std::vector<double> drawn(const DrawSpec& draw, std::span<const int> blocks, int participant,
                          uint64_t seed);

}  // namespace dihaptic::task
