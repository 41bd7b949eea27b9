// Between links a task's director with what decides between its trials outside of the tick: a
// script that chooses the next trial's variables, or which trial is next. In real time neither side
// waits for the other; what comes too late is left out, and the trials go on as the file has them.
// On the virtual clock the director waits, so that a rehearsal decides as a session does.
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

/// How an attempt ended; what is asked for is decided before the next one begins.
struct Ended {
    int64_t number = 0;          ///< of the question, from 1
    int32_t trial = 0;           ///< from 1; 0: the session begins
    int32_t attempt = 0;         ///< from 1
    int32_t outcome = -1;        ///< index in the plan's list
    VariableValues variables{};  ///< as the file's rules leave them [SI]
};

/// What is to be done next.
struct Decision {
    int64_t number = 0;    ///< of the question
    int32_t next = 0;      ///< number of the trial to do next, if it is still to be done in the
                           ///< block; 0: the file's order
    int32_t message = -1;  ///< index in the plan's list, shown as feedback; -1: none
    VariableValues variables = unchanged();  ///< NaN: stays [SI]

    static VariableValues unchanged() noexcept {
        VariableValues out;
        out.fill(kUnmeasured);
        return out;
    }
};

class Between {
  public:
    /// `patience`: time after an attempt's end in which its answer counts, in real time [s].
    /// `waits`: the clock is virtual.
    Between(double patience, bool waits) : patience_(patience), waits_(waits) {}

    double patience() const noexcept { return patience_; }

    // The director's side
    void ask(Ended ended) noexcept {
        ended.number = ++asked_;
        questions_.publish(ended);
    }
    /// The answer to the newest question; null: there is none yet.
    const Decision* answer() noexcept {
        const auto end = std::chrono::steady_clock::now() + kLongest;
        while (waits_ && !gone_ && decisions_.read().number != asked_) {
            if (std::chrono::steady_clock::now() > end) gone_ = true;
            std::this_thread::sleep_for(std::chrono::microseconds(50));
        }
        const Decision& newest = decisions_.read();
        return newest.number == asked_ ? &newest : nullptr;
    }
    /// Whether answers come at all.
    bool gone() const noexcept { return gone_; }
    void note_late() noexcept { late_.fetch_add(1, std::memory_order_relaxed); }
    void note_refused() noexcept { refused_.fetch_add(1, std::memory_order_relaxed); }

    // The other side
    /// The newest question that was not yet taken.
    std::optional<Ended> question() noexcept {
        if (!questions_.is_new()) return std::nullopt;
        return questions_.read();
    }
    void decide(const Decision& decision) noexcept { decisions_.publish(decision); }
    /// No answer will come any more.
    void leave() noexcept { gone_ = true; }
    /// Number of attempts whose answer came too late.
    int late() const noexcept { return late_.load(std::memory_order_relaxed); }
    /// Number of decisions for a trial that was not to be done in the block.
    int refused() const noexcept { return refused_.load(std::memory_order_relaxed); }

    /// In virtual time a session waits no longer than this for an answer, and then for none.
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
