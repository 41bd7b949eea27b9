// Runs a session's trials inside the tick: keeps the current state, commands what it shows and
// perturbs, judges its exits, and chooses the next trial. Once constructed it neither allocates,
// locks nor throws.
#pragma once

#include <atomic>

#include "servo/servo.h"
#include "task/task_plan.h"

namespace dihaptic::task {

class TaskDirector {
  public:
    /// `plan` must outlive the director. `done`: attempts made by an earlier part of the session,
    /// in order.
    TaskDirector(const TaskPlan& plan, uint64_t seed, double tick,
                 const std::vector<Attempt>& done = {});

    void operator()(const servo::Frame& last, std::span<const haptics::Handle> handles,
                    servo::Commands& commands) noexcept;

    /// The operator pressed a key; from any thread.
    void press(char key) noexcept { key_.store(key, std::memory_order_relaxed); }
    /// A trigger came from outside; from any thread. `code`: 1 to 255, or kAnyTrigger.
    void trigger(int code) noexcept { trigger_.store(code, std::memory_order_relaxed); }
    static constexpr int kAnyTrigger = -1;  ///< counts as any code that is waited for
    /// Ends the trial in the next tick, as skipped and not to be done again; from any thread.
    void skip() noexcept { skip_.store(true, std::memory_order_relaxed); }
    /// Call between two ticks: a running trial begins anew.
    void interrupt() noexcept {
        if (!queue_.empty() && state_ >= 0) queue_.again();
        state_ = -1;
    }
    /// Share of the trials that are done, from any thread.
    double share() const noexcept { return share_.load(std::memory_order_relaxed); }

  private:
    const Trial& trial() const { return plan_.trials[static_cast<size_t>(queue_.trial())]; }
    bool clear(const servo::Frame& last) const noexcept;
    /// Begins the next trial once the last feedback has been read and bodies can be put back.
    void begin(const servo::Frame& last, double now, servo::Commands& commands) noexcept;
    void enter(int state, double now, servo::Commands& commands) noexcept;
    /// What came in from outside since the last tick.
    struct Input {
        char key;     // 0: none
        int trigger;  // 0: none
    };
    bool holds(const TaskPlan::Way& way, const servo::Frame& last,
               std::span<const haptics::Handle> handles, const Input& input) const noexcept;
    bool inside(const TaskPlan::Way& way, const servo::Frame& last,
                std::span<const haptics::Handle> handles) const noexcept;
    bool lifted(const TaskPlan::Way& way, const servo::Frame& last) const noexcept;
    bool pressed(const servo::Frame& last, int body, int finger, int fingers) const noexcept;
    const TaskPlan::Way* way_out(const servo::Frame& last, std::span<const haptics::Handle> handles,
                                 const Input& input, double now) noexcept;
    void finish(int outcome, bool redo, double now, servo::Commands& commands) noexcept;
    void order_end(double now, servo::Commands& commands) const noexcept;
    void order(const servo::Frame& last, std::span<const haptics::Handle> handles,
               servo::Commands& commands) const noexcept;

    /// Skips trials whose procedure is done: it may need fewer trials than the list has.
    void skip_done() noexcept;
    double level() const noexcept;
    double share_of_trial() const noexcept;
    void take_answer(int outcome) noexcept;

    const TaskPlan& plan_;
    double tick_;
    std::vector<Procedure> procedures_;
    TrialQueue queue_;
    int state_ = -1;      // -1: between trials
    double entered_ = 0;  // [s]
    int message_ = -1;
    int next_message_ = -1;       // shown once the feedback has been read
    double feedback_until_ = -1;  // [s]
    int last_trial_ = 0;          // last trial that ended, from 1; 0: none yet
    int last_attempt_ = 0;
    std::vector<double>
        since_;  // by way: when its condition began to hold; -1: it does not hold [s]
    std::atomic<char> key_{0};
    std::atomic<int> trigger_{0};
    std::atomic<bool> skip_{false};
    std::atomic<double> share_{0};
};

}  // namespace dihaptic::task
