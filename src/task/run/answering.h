// A participant's answers to the questions of a state, as processed in each tick. Nothing here
// allocates or throws.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <span>

#include "task/plan/task_plan.h"

namespace dihaptic::task {

/// Maximum number of keys that can wait until a tick reads them; further keys are refused. A window
/// that draws slowly may pass on several keys at once.
constexpr size_t kMostKeys = 64;

/// A click on the line of a question. Aligned to its size, because otherwise Clang exchanges an
/// atomic one by a call of a library, which may lock.
struct alignas(8) Click {
    /// Index of the question; the number of questions stands for "done", -1 for no click.
    int32_t item = -1;
    /// Distance from the left end of the line, in millionths of the line's length.
    int32_t place = 0;

    /// Makes a click. `share` is the position on the line as a share of the line's length, from 0
    /// to 1.
    static Click at(size_t item, double share) noexcept {
        return {static_cast<int32_t>(item), static_cast<int32_t>(std::lround(share * kPlaces))};
    }
    double share() const noexcept { return place / kPlaces; }

  private:
    static constexpr double kPlaces = 1e6;
};

class Answering {
  public:
    /// Starts the questions of a state, all of them unanswered.
    void begin(const TaskPlan::Questions& questions) noexcept;
    void press(char key) noexcept;
    void click(const Click& click) noexcept;
    /// Uses the hand's position on the line from `from_W` to `to_W` as the answer.
    void point(const Vec3& p_W, const Vec3& from_W, const Vec3& to_W) noexcept;

    /// Messages shown for the current question.
    std::span<const int> lines() const noexcept;
    /// Whether the only question has been answered, or the form has been confirmed.
    bool answered() const noexcept;
    /// Index of the question being asked, or the number of questions once all have been answered.
    size_t item() const noexcept { return item_; }
    /// Answer to a question, in the unit of the answer's name; NaN until it is given.
    double answer(size_t item) const noexcept { return answers_[item]; }
    /// The number typed so far or, once it is given, the answer.
    double shown() const noexcept { return rating_.shown(); }

  private:
    size_t count() const noexcept { return questions_ == nullptr ? 0 : questions_->items.size(); }
    void give(size_t item, double answer) noexcept;
    void reopen(size_t item) noexcept;
    void ask_next() noexcept;

    const TaskPlan::Questions* questions_ = nullptr;
    Rating rating_;  // the answer to the current question
    std::array<double, frame::TaskFrame::kMostVariables> answers_{};
    std::array<bool, frame::TaskFrame::kMostVariables> given_{};
    size_t item_ = 0;
    bool confirmed_ = false;
    // whether the last key completed a number, which makes Enter superfluous
    bool ended_itself_ = false;
};

}  // namespace dihaptic::task
