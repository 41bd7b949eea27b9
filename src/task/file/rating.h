// Ratings: a state asks for a number on a scale, which is typed, clicked on a line in the window,
// or given by the hand's position on a line between two regions. The number is recorded in each
// tick, and can be used in expressions.
#pragma once

#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "base/field_reader.h"
#include "base/geometry.h"
#include "task/file/ref.h"
#include "task/file/region.h"

namespace dihaptic::task {

/// numbers: integers; vas: a visual analogue scale; likert: numbers from 1, each with a label;
/// magnitude: any number from 0 up.
enum class Scale { numbers, vas, likert, magnitude };
constexpr auto enum_names(Scale) {
    return std::array{"numbers", "vas", "likert", "magnitude"};
}
/// Upper end of a scale of magnitudes for which none is given.
constexpr double kMostMagnitude = 1e6;

enum class AnswerBy { key, mouse, cursor };
constexpr auto enum_names(AnswerBy) {
    return std::array{"key", "mouse", "cursor"};
}

/// A question as described in an experiment file.
struct AskSpec {
    std::string name;  ///< name of the answer, which may end in its unit
    std::string question;
    Scale scale = Scale::numbers;
    std::optional<double> from;
    std::optional<double> to;
    std::vector<std::string> labels;  ///< of the ends or, on a likert scale, of all numbers
    AnswerBy by = AnswerBy::key;
    RefList<Region> between;          ///< for `cursor`: regions at the ends of the line
    bool optional = false;            ///< Enter alone leaves the question unanswered
    std::optional<double> simulated;  ///< answer of simulated people; unset: random
    Place place;

    template <class Visitor>
    void visit(Visitor& v) {
        const Field end = Field::number().within(-kMostMagnitude, kMostMagnitude);
        v("name", name,
          Field::text().required().says("Name of the answer, which may end in its unit."));
        v("question", question, says("Text above the scale."));
        v("scale", scale,
          Field::text().required().says("Kind of scale, which determines the possible answers."));
        v("from", from,
          end.says("Smallest answer; on a likert scale the number of the first label, 1 if "
                   "omitted."));
        v("to", to, end.says("Largest answer."));
        v("labels", labels,
          says("Texts at the ends of the scale or, on a likert scale, at all its numbers."));
        v("by", by,
          says("Input method: typing, a mouse click on a line in the window (typing then works "
               "too), or pointing with the haptic cursor."));
        v("between", between,
          says(
              "Regions at the ends of the line on which the cursor points; only with by: cursor."));
        v("simulated_answer", simulated,
          end.says("Answer that simulated people give; a random one if omitted."));
        v("optional", optional,
          says("Whether an item of a form may be left out, by pressing Enter alone."));
    }

    double least() const;
    double most() const;
    bool whole() const { return scale == Scale::numbers || scale == Scale::likert; }
};

/// Problems within the spec itself go to `diagnostics`.
void check(const AskSpec& spec, Diagnostics& diagnostics);
/// The scale in words, with a placeholder for the answer that is typed or pointed at.
std::string line_of(const AskSpec& spec);

/// A question whose names have been looked up.
struct Question {
    double least = 0;  ///< in the unit of the answer's name, like `most`
    double most = 1;
    bool whole = true;
    bool optional = false;
    std::optional<double> simulated;
    AnswerBy by = AnswerBy::key;
    int from = -1;  ///< regions at the ends of the line
    int to = -1;
    size_t variable = 0;  ///< index of the answer among the variables of frames
    double si = 1;        ///< unit of the answer's name, in SI
};

/// The answer to a question while it is being given. In the tick it neither allocates nor throws.
class Rating {
  public:
    static constexpr size_t kLongest = 8;  ///< largest number of characters
    static constexpr char kEnter = '\r';
    static constexpr char kBack = '\b';

    void begin() noexcept;
    /// Processes a key: a digit, point, minus, back or enter. A number ends with enter, or when no
    /// further digit could follow.
    void press(char key, const Question& question) noexcept;
    /// Uses a position on the scale's line, from 0 to 1, as the answer.
    void click(double share, const Question& question) noexcept;
    /// Uses the hand's position on the line from `from_W` to `to_W`.
    void point(const Vec3& p_W, const Vec3& from_W, const Vec3& to_W,
               const Question& question) noexcept;

    /// NaN until an answer is given; in the unit of the answer's name, like `shown`.
    double answer() const noexcept { return answer_; }
    /// The number typed so far, or the answer.
    double shown() const noexcept;
    /// Whether nothing has been typed or answered.
    bool empty() const noexcept { return length_ == 0 && std::isnan(answer_); }

  private:
    static constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
    double typed() const noexcept;
    static double at(double share, const Question& question) noexcept;

    std::array<char, kLongest + 1> text_{};
    size_t length_ = 0;
    double answer_ = kNone;
};

}  // namespace dihaptic::task
