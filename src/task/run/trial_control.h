// TrialControl connects a task's director to a program that decides before each attempt, outside
// the tick, how the session continues. Such a program is a script that chooses the variables of the
// next trial, or the next trial itself. In real time, neither side waits for the other: late
// decisions are discarded, and the trials continue as in the file. On the virtual clock, the
// director waits, so that a rehearsal makes the same decisions as a session.
#pragma once

#include <array>
#include <atomic>
#include <chrono>
#include <cmath>
#include <optional>
#include <thread>

#include "base/latest.h"
#include "base/unmeasured.h"
#include "frame/task_frame.h"

namespace dihaptic::task {

using VariableValues = std::array<double, frame::TaskFrame::kMostVariables>;

/// A question to the program: the result of an attempt. A decision is requested before the next
/// attempt starts.
struct Ended {
    int64_t number = 0;  ///< number of the question, counted from 1
    /// Number of the trial that ended, counted from 1; 0 at the start of the session.
    int32_t trial = 0;
    int32_t attempt = 0;         ///< number of the attempt, counted from 1
    int32_t outcome = -1;        ///< index of the outcome in the plan
    VariableValues variables{};  ///< values after the rules in the file have been applied [SI]
};

/// The program's decision about the next attempt.
struct Decision {
    int64_t number = 0;  ///< number of the question that this decision answers
    int32_t next = 0;  ///< number of the next trial, which must be pending in the block; 0 for the
                       ///< order in the file
    int32_t message = -1;  ///< index in the plan of a message shown as feedback; -1 for none
    VariableValues variables = unchanged();  ///< new values of the variables; NaN if unchanged [SI]

    static VariableValues unchanged() noexcept {
        VariableValues out;
        out.fill(kUnmeasured);
        return out;
    }
};

class TrialControl {
  public:
    /// `patience` is the time allowed for an answer after the end of an attempt, in real time [s].
    /// `waits` is true if the clock is virtual.
    TrialControl(double patience, bool waits) : patience_(patience), waits_(waits) {}

    double patience() const noexcept { return patience_; }

    // functions for the director
    void ask(Ended ended) noexcept {
        ended.number = ++asked_;
        questions_.publish(ended);
    }
    /// Returns the answer to the newest question, or null if there is none yet.
    const Decision* answer() noexcept {
        const auto end = std::chrono::steady_clock::now() + kLongest;
        while (waits_ && !gone_ && decisions_.read().number != asked_) {
            if (std::chrono::steady_clock::now() > end) gone_ = true;
            std::this_thread::sleep_for(std::chrono::microseconds(50));
        }
        const Decision& newest = decisions_.read();
        return newest.number == asked_ ? &newest : nullptr;
    }
    /// Whether no more answers will come.
    bool gone() const noexcept { return gone_; }
    void note_late() noexcept { late_.fetch_add(1, std::memory_order_relaxed); }
    void note_refused() noexcept { refused_.fetch_add(1, std::memory_order_relaxed); }

    // functions for the program that decides
    /// Returns the newest question, or nullopt if it has already been fetched.
    std::optional<Ended> question() noexcept {
        if (!questions_.is_new()) return std::nullopt;
        return questions_.read();
    }
    void decide(const Decision& decision) noexcept { decisions_.publish(decision); }
    /// Announces that no more answers will come.
    void leave() noexcept { gone_ = true; }
    /// Number of attempts for which the answer came too late.
    int late() const noexcept { return late_.load(std::memory_order_relaxed); }
    /// Number of decisions that chose a trial that was not pending in the block.
    int refused() const noexcept { return refused_.load(std::memory_order_relaxed); }

    /// Longest time to wait for an answer if the clock is virtual. After a timeout, the session no
    /// longer waits for answers.
    static constexpr std::chrono::seconds kLongest{60};

  private:
    double patience_;
    bool waits_;
    int64_t asked_ = 0;
    Latest<Ended> questions_;
    Latest<Decision> decisions_;
    std::atomic<bool> gone_{false};
    std::atomic<int> late_{0};
    std::atomic<int> refused_{0};
};

}  // namespace dihaptic::task
