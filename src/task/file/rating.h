// Ratings: a state asks for a number on a scale. The number is typed, clicked on a line in the
// window, or indicated by the hand's position on a line between two regions. The number is
// recorded in each tick and can be used in expressions.
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

/// Kind of scale. numbers: integers; vas: a visual analogue scale; likert: numbers from 1, each
/// with a label; magnitude: any non-negative number.
enum class Scale { numbers, vas, likert, magnitude };
constexpr auto enum_names(Scale) {
    return std::array{"numbers", "vas", "likert", "magnitude"};
}
/// Upper end of a magnitude scale if none is given.
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
    std::vector<std::string> labels;  ///< labels of the ends or, on a likert scale, of all numbers
    AnswerBy by = AnswerBy::key;
    RefList<Region> between;  ///< for `cursor`, the regions at the ends of the line
    bool optional = false;    ///< whether the question can be left unanswered by pressing Enter
    /// Answer of simulated people; if unset, the answer is random.
    std::optional<double> simulated;
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

/// Checks the spec by itself. Problems are added to `diagnostics`.
void check(const AskSpec& spec, Diagnostics& diagnostics);
/// Returns the scale as text, with a placeholder for the answer, which is typed or pointed at.
std::string line_of(const AskSpec& spec);

/// A question whose names have been looked up.
struct Question {
    /// Lower end of the scale in the unit of the answer's name; `most` is the upper end.
    double least = 0;
    double most = 1;
    bool whole = true;
    bool optional = false;
    std::optional<double> simulated;
    AnswerBy by = AnswerBy::key;
    int from = -1;  ///< indices of the regions at the ends of the line
    int to = -1;
    size_t variable = 0;  ///< index of the answer among the variables in frames
    double si = 1;        ///< unit of the answer's name, as a multiple of the SI unit
};

/// The answer to a question while it is being given. Rating does not allocate or throw during a
/// tick.
class Rating {
  public:
    static constexpr size_t kLongest = 8;  ///< maximum number of characters
    static constexpr char kEnter = '\r';
    static constexpr char kBack = '\b';

    void begin() noexcept;
    /// Processes a key: a digit, point, minus, back or enter. A number is complete when enter is
    /// pressed, or as soon as no further digit could follow.
    void press(char key, const Question& question) noexcept;
    /// Uses a position on the line of the scale, from 0 to 1, as the answer.
    void click(double share, const Question& question) noexcept;
    /// Uses the hand's position on the line from `from_W` to `to_W` as the answer.
    void point(const Vec3& p_W, const Vec3& from_W, const Vec3& to_W,
               const Question& question) noexcept;

    /// The answer in the unit of its name; NaN until it is given.
    double answer() const noexcept { return answer_; }
    /// The number typed so far or, once it is given, the answer, in the unit of the answer's name.
    double shown() const noexcept;
    /// Whether nothing has been typed and no answer given.
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
