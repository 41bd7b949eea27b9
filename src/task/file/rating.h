// Ratings: a state asks for a number on a scale, which is typed, clicked on a line in the window,
// or shown by the hand's place on a line between two regions. The number is recorded in each tick,
// and is a quantity that expressions can name.
#pragma once

#include <array>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "base/field_reader.h"
#include "base/geometry.h"
#include "task/file/ref.h"
#include "task/file/region.h"

namespace dihaptic::task {

/// numbers: whole ones; vas: a visual analogue scale; likert: a label for each number from 1 on;
/// magnitude: any number from 0 on.
enum class Scale { numbers, vas, likert, magnitude };
constexpr auto enum_names(Scale) {
    return std::array{"numbers", "vas", "likert", "magnitude"};
}
enum class AnswerBy { key, mouse, cursor };
constexpr auto enum_names(AnswerBy) {
    return std::array{"key", "mouse", "cursor"};
}

/// A question as an experiment file has it.
struct AskSpec {
    std::string name;  ///< of the answer, in whose unit it is
    Scale scale = Scale::numbers;
    std::optional<double> from;
    std::optional<double> to;
    std::vector<std::string> labels;  ///< of the ends, or, on a likert scale, of all numbers
    AnswerBy by = AnswerBy::key;
    RefList<Region> between;  ///< cursor: at the ends of the line
    Place place;

    template <class Visitor>
    void visit(Visitor& v) {
        const Field end = Field::number().within(-1e6, 1e6);
        v("name", name,
          Field::text().required().says("Name of the answer, which may end in its unit."));
        v("scale", scale, Field::text().required().says("What can be answered."));
        v("from", from, end.says("Smallest answer."));
        v("to", to, end.says("Largest answer."));
        v("labels", labels,
          says("Texts at the ends of the scale, or, on a likert scale, of all its numbers."));
        v("by", by,
          says("How it is answered: typed, clicked with the mouse on a line in the window (or "
               "typed all the "
               "same), or pointed at with the haptic cursor."));
        v("between", between,
          says("Regions at the ends of the line that the cursor points at; of cursor alone."));
        if constexpr (requires { v.place(); }) place = v.place();
    }

    double least() const;
    double most() const;
    bool whole() const { return scale == Scale::numbers || scale == Scale::likert; }
};

/// Problems with the spec alone go to `diagnostics`.
void check(const AskSpec& spec, Diagnostics& diagnostics);
/// The scale in words, with a place for what is typed or shown.
std::string line_of(const AskSpec& spec);

/// A question with its names looked up.
struct Question {
    double least = 0;  ///< in the unit of the answer's name, as `most`
    double most = 1;
    bool whole = true;
    AnswerBy by = AnswerBy::key;
    int from = -1;  ///< regions of the line
    int to = -1;
    size_t variable = 0;  ///< index of the answer among the variables of frames
    double si = 1;        ///< unit of its name
};

/// The answer to a question as it comes about. In the tick it neither allocates nor throws.
class Rating {
  public:
    static constexpr char kEnter = '\r';
    static constexpr char kBack = '\b';
    static constexpr double kNowhere = -1;  ///< there was no click

    void begin() noexcept;
    /// Takes a key: digits, a point, a minus, back or enter. A number is over by enter, or when no
    /// other digit could follow it.
    void press(char key, const Question& question) noexcept;
    /// Takes a place on the scale's line, from 0 to 1, which is the answer.
    void click(double share, const Question& question) noexcept;
    /// Takes the hand's place on the line from `from_W` to `to_W`.
    void point(const Vec3& p_W, const Vec3& from_W, const Vec3& to_W,
               const Question& question) noexcept;

    /// NaN until it is given; in the unit of its name, as `shown`.
    double answer() const noexcept { return answer_; }
    /// What is typed so far, or the answer.
    double shown() const noexcept;

  private:
    static constexpr size_t kLongest = 8;
    static constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
    double typed() const noexcept;
    static double at(double share, const Question& question) noexcept;

    std::array<char, kLongest + 1> text_{};
    size_t length_ = 0;
    double answer_ = kNone;
};

}  // namespace dihaptic::task
