// TrialControl links a task's director to a program that decides, before each attempt and outside
// the tick, how the session goes on: a script that chooses the variables of the next trial, or the
// next trial itself. In real time neither side waits for the other; late decisions are discarded,
// and the trials continue as in the file. On the virtual clock the director waits, so that a
// rehearsal makes the same decisions as a session.
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

/// A question: the result of an attempt, on which a decision is requested before the next attempt
/// starts.
struct Ended {
    int64_t number = 0;          ///< number of the question, from 1
    int32_t trial = 0;           ///< trial that ended, from 1; 0: at the session's start
    int32_t attempt = 0;         ///< from 1
    int32_t outcome = -1;        ///< index in the plan
    VariableValues variables{};  ///< after the file's rules [SI]
};

/// The decision about the next attempt.
struct Decision {
    int64_t number = 0;    ///< number of the question
    int32_t next = 0;      ///< number of a trial pending in the block; 0: file order
    int32_t message = -1;  ///< index in the plan, shown as feedback; -1: none
    VariableValues variables = unchanged();  ///< NaN: unchanged [SI]

    static VariableValues unchanged() noexcept {
        VariableValues out;
        out.fill(kUnmeasured);
        return out;
    }
};

class TrialControl {
  public:
    /// `patience`: time limit for the answer after an attempt's end, in real time [s].
    /// `waits`: the clock is virtual.
    TrialControl(double patience, bool waits) : patience_(patience), waits_(waits) {}

    double patience() const noexcept { return patience_; }

    // The director's side
    void ask(Ended ended) noexcept {
        ended.number = ++asked_;
        questions_.publish(ended);
    }
    /// The answer to the newest question; null: none yet.
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

    // The other side
    /// The newest question that was not yet fetched.
    std::optional<Ended> question() noexcept {
        if (!questions_.is_new()) return std::nullopt;
        return questions_.read();
    }
    void decide(const Decision& decision) noexcept { decisions_.publish(decision); }
    /// Announces that no more answers will come.
    void leave() noexcept { gone_ = true; }
    /// Number of attempts with a late answer.
    int late() const noexcept { return late_.load(std::memory_order_relaxed); }
    /// Number of decisions for a trial that was not pending in the block.
    int refused() const noexcept { return refused_.load(std::memory_order_relaxed); }

    /// Longest wait for an answer in virtual time; after a timeout, the session stops waiting for
    /// answers.
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
