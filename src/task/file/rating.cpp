#include "task/file/rating.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>

namespace dihaptic::task {
namespace {

constexpr double kEndOfVas = 100;
constexpr double kTypedBase = 10;
constexpr size_t kMostLabels = 9;

void check_likert(const AskSpec& spec, Diagnostics& diagnostics) {
    if (spec.to)
        diagnostics.error(spec.place, "to",
                          "cannot be set: a likert scale has as many numbers as labels",
                          "Leave it out: each label gets a number.");
    if (spec.least() != std::round(spec.least()))
        diagnostics.error(spec.place, "from", "is not a whole number",
                          "Write the number of the first label, e.g. from: 0.");
    if (spec.labels.size() < 2 || spec.labels.size() > kMostLabels)
        diagnostics.error(spec.place, "labels",
                          fmt::format("there are {}, but a likert scale has 2 to {}",
                                      spec.labels.size(), kMostLabels),
                          "Give each number a label, e.g. labels: [no, rather not, rather, yes].");
}

void check_ends(const AskSpec& spec, Diagnostics& diagnostics) {
    if (!spec.labels.empty() && spec.labels.size() != 2)
        diagnostics.error(spec.place, "labels",
                          fmt::format("there are {}, but a scale has two ends", spec.labels.size()),
                          "Name the ends, e.g. labels: [light, heavy], or use scale: likert.");
    if (spec.scale == Scale::numbers && (!spec.from || !spec.to))
        diagnostics.error(spec.place, spec.from ? "to" : "from", "is missing",
                          "Add e.g. from: 1, to: 9.");
    if (spec.most() <= spec.least())
        diagnostics.error(spec.place, "to",
                          fmt::format("is {:g}, but must be above 'from', which is {:g}",
                                      spec.most(), spec.least()),
                          "Make 'to' greater than 'from'.");
    if (spec.scale == Scale::magnitude && spec.least() < 0)
        diagnostics.error(spec.place, "from", "is negative, but a magnitude cannot be",
                          "Leave it out: the default is 0.");
}

void check_by(const AskSpec& spec, Diagnostics& diagnostics) {
    const bool cursor = spec.by == AnswerBy::cursor;
    if (spec.by != AnswerBy::key && spec.scale == Scale::magnitude)
        diagnostics.error(spec.place, "by",
                          "a line has two ends, but a magnitude has no upper limit",
                          "Use by: key, or scale: vas.");
    if (cursor && spec.between.size() != 2)
        diagnostics.error(spec.place, "between", "is missing: the line needs a region at each end",
                          "Add e.g. between: [low, high].");
    if (!cursor && !spec.between.empty())
        diagnostics.error(spec.place, "between",
                          fmt::format("cannot be used with 'by: {}'", enum_name(spec.by)),
                          "Leave it out, or write by: cursor.");
}

/// Checks that the simulated answer lies on the scale and that it can be typed.
void check_simulated(const AskSpec& spec, double simulated, Diagnostics& diagnostics) {
    std::array<char, Rating::kLongest> keys{};
    const bool typed =
        std::to_chars(keys.data(), keys.data() + keys.size(), simulated, std::chars_format::fixed)
            .ec == std::errc();
    if (!typed || simulated < spec.least() || simulated > spec.most() ||
        (spec.whole() && simulated != std::round(simulated)))
        diagnostics.error(
            spec.place, "simulated_answer",
            fmt::format("{:g} is not an answer on the scale", simulated),
            fmt::format("Write a number from {:g} to {:g}, with at most {} characters.",
                        spec.least(), spec.most(), Rating::kLongest));
}

/// Whether the key can be the next character of a number.
bool is_of_number(char key, bool first, const Question& question) noexcept {
    if (std::isdigit(static_cast<unsigned char>(key)) != 0) return true;
    return key == '.' ? !question.whole : key == '-' && first && question.least < 0;
}

}  // namespace

double AskSpec::least() const {
    return from.value_or(scale == Scale::likert ? 1 : 0);
}

double AskSpec::most() const {
    if (scale == Scale::likert) return least() + static_cast<double>(labels.size()) - 1;
    return to.value_or(scale == Scale::vas ? kEndOfVas : kMostMagnitude);
}

void check(const AskSpec& spec, Diagnostics& diagnostics) {
    if (spec.scale == Scale::likert) {
        check_likert(spec, diagnostics);
    } else {
        check_ends(spec, diagnostics);
    }
    check_by(spec, diagnostics);
    if (spec.simulated) check_simulated(spec, *spec.simulated, diagnostics);
}

std::string line_of(const AskSpec& spec) {
    std::vector<std::string> parts;
    const auto plain = [](const std::string& text) {
        std::string out;  // escapes braces, which in a label do not mark a number
        for (const char c : text)
            out += c == '{' || c == '}' ? std::string(2, c) : std::string(1, c);
        return out;
    };
    if (spec.scale == Scale::likert) {
        for (size_t i = 0; i < spec.labels.size(); ++i)
            parts.push_back(fmt::format("{:g} {}", spec.least() + static_cast<double>(i),
                                        plain(spec.labels[i])));
    } else if (spec.labels.size() == 2) {
        parts.push_back(fmt::format("{:g} {}", spec.least(), plain(spec.labels[0])));
        parts.push_back(fmt::format("{:g} {}", spec.most(), plain(spec.labels[1])));
    } else if (spec.scale != Scale::magnitude) {
        parts.push_back(fmt::format("{:g} to {:g}", spec.least(), spec.most()));
    }
    return fmt::format("{}{}{{answer}}", fmt::join(parts, " ... "), parts.empty() ? "" : ": ");
}

void Rating::begin() noexcept {
    length_ = 0;
    answer_ = kNone;
}

double Rating::typed() const noexcept {
    double value = kNone;
    const char* const end = text_.data() + length_;
    const auto [at, failed] = std::from_chars(text_.data(), end, value);
    return failed == std::errc() && at == end ? value + 0.0 : kNone;  // adding 0.0 turns -0 into 0
}

double Rating::shown() const noexcept {
    return std::isnan(answer_) ? typed() : answer_;
}

void Rating::press(char key, const Question& question) noexcept {
    if (!std::isnan(answer_)) return;
    if (key == kBack && length_ > 0) --length_;
    const bool more = is_of_number(key, length_ == 0, question) && length_ < kLongest;
    if (more) text_[length_++] = key;
    const double value = typed();
    const bool full = more && question.whole &&
                      (value == 0 || kTypedBase * value > question.most ||
                       (value < 0 && kTypedBase * value < question.least));
    if (key != kEnter && !full) return;
    if (value >= question.least && value <= question.most) {
        answer_ = value;
    } else {
        length_ = 0;
    }
}

void Rating::point(const Vec3& p_W, const Vec3& from_W, const Vec3& to_W,
                   const Question& question) noexcept {
    const Vec3 way = to_W - from_W;
    const double square = way.squaredNorm();
    answer_ = at(square > 0 ? (p_W - from_W).dot(way) / square : 0, question);
}

void Rating::click(double share, const Question& question) noexcept {
    if (std::isnan(answer_)) answer_ = at(share, question);
}

double Rating::at(double share, const Question& question) noexcept {
    const double answer =
        question.least + std::clamp(share, 0.0, 1.0) * (question.most - question.least);
    return (question.whole ? std::round(answer) : answer) + 0.0;  // adding 0.0 turns -0 into 0
}

}  // namespace dihaptic::task
