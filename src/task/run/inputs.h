// Input to a task from other threads: keys, clicks, triggers, and the wish to skip a trial.
#pragma once

#include <atomic>

#include "base/ring.h"
#include "task/run/answering.h"

namespace dihaptic::task {

/// Input since the last tick.
struct Input {
    char key = 0;     ///< 0 if there is none
    int trigger = 0;  ///< 0 if there is none
    Click clicked;
};

class Inputs {
  public:
    static constexpr int kAnyTrigger = -1;  ///< a trigger that matches every expected code

    /// Must be called from one thread only.
    void press(char key) noexcept { keys_.push(key); }
    void click(const Click& click) noexcept { clicked_.store(click, std::memory_order_relaxed); }
    void trigger(int code) noexcept { trigger_.store(code, std::memory_order_relaxed); }
    void skip() noexcept { skip_.store(true, std::memory_order_relaxed); }

    Input take() noexcept {
        return {keys_.pop().value_or(0), trigger_.exchange(0, std::memory_order_relaxed),
                clicked_.exchange(Click{}, std::memory_order_relaxed)};
    }
    bool take_skip() noexcept { return skip_.exchange(false, std::memory_order_relaxed); }

  private:
    ValueRing<char> keys_{kMostKeys};
    std::atomic<Click> clicked_{Click{}};
    std::atomic<int> trigger_{0};
    std::atomic<bool> skip_{false};
};

}  // namespace dihaptic::task
