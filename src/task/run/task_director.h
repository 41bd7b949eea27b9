// Runs the trials of a session, tick by tick: tracks the current state, commands its display and
// perturbations, evaluates its exits, and chooses the next trial. After construction, the director
// does not allocate, lock or throw.
#pragma once

#include <atomic>

#include "frame/orders.h"
#include "task/run/answering.h"
#include "task/run/deciding.h"
#include "task/run/displayer.h"
#include "task/run/inputs.h"
#include "task/run/messages.h"
#include "task/run/opening.h"
#include "task/run/placer.h"
#include "task/run/rules.h"
#include "task/run/sounder.h"
#include "task/run/trial_numbers.h"

namespace dihaptic::task {

class TaskDirector {
  public:
    /// `plan` must outlive the director. `done` contains the attempts in an earlier part of the
    /// session, in order.
    TaskDirector(const TaskPlan& plan, uint64_t seed, double tick,
                 const std::vector<Attempt>& done = {});

    void operator()(const frame::Frame& last, std::span<const frame::Handle> handles,
                    frame::Commands& commands) noexcept;

    /// Queues a key that the operator has pressed, to be read in a tick. Must be called from one
    /// thread only.
    void press(char key) noexcept { inputs_.press(key); }
    /// Passes on a click on the line of a question. May be called from any thread.
    void click(const Click& click) noexcept { inputs_.click(click); }
    /// Passes on an external trigger. `code` is 1 to 255, or kAnyTrigger. May be called from any
    /// thread.
    void trigger(int code) noexcept { inputs_.trigger(code); }
    static constexpr int kAnyTrigger = Inputs::kAnyTrigger;
    /// Ends the trial as skipped in the next tick. The trial is not repeated. May be called from
    /// any thread.
    void skip() noexcept { inputs_.skip(); }
    /// Makes the director ask `between` for a decision before each attempt. `between` must outlive
    /// the director. Must be called before the first tick.
    void decide_by(TrialControl& between) noexcept;
    /// Restarts a running trial. Must be called between two ticks.
    void interrupt() noexcept {
        if (!queue_.empty() && current_.state >= 0) queue_.again();
        current_.state = -1;
        current_.begun = false;
        rules_.clear();
        motions_.forget();
    }
    /// The numbers in the trials so far, including a record of formulas that had to be kept within
    /// bounds.
    const TrialNumbers& numbers() const noexcept { return numbers_; }
    /// What keeps a body from being placed at its start pose. Must be called between ticks.
    Placer::Obstacle obstacle() const noexcept { return placer_.obstacle(); }
    const Placer::Missed& missed_placements() const noexcept { return placer_.missed(); }
    /// Number of trials that were left out because an exit ended the session.
    size_t left_out() const noexcept { return queue_.left_out(); }
    /// Share of trials that have been completed. May be called from any thread.
    double share() const noexcept { return share_.load(std::memory_order_relaxed); }

  private:
    const Trial& trial() const { return plan_.trials[static_cast<size_t>(queue_.trial())]; }
    /// The current state. Must not be called between trials.
    const TaskPlan::PlannedState& planned() const {
        return plan_.states[static_cast<size_t>(current_.state)];
    }
    /// Time until which feedback is shown that is given now; half a tick of tolerance allows for
    /// rounding errors in sums of ticks.
    double feedback_until(double now) const { return now + plan_.task.feedback - tick_ / 2; }
    /// Starts the next trial once the last feedback and the block's pages are over and the bodies
    /// can be placed at their start poses.
    void begin(const frame::Frame& last, char key, double now, frame::Commands& commands) noexcept;
    /// Asks the program that decides about the next attempt for its decision, if there is such a
    /// program.
    void ask(int attempt, int outcome, double now) noexcept;
    bool follow(const Decision& decision, double now) noexcept;
    void enter(int state, double now, frame::Commands& commands) noexcept;
    bool holds(const TaskPlan::Transition& transition, const frame::Frame& last,
               const Input& input) const noexcept;
    const TaskPlan::Transition* transition_taken(const frame::Frame& last, const Input& input,
                                                 double now) noexcept;
    void finish(int outcome, bool redo, double now, frame::Commands& commands) noexcept;
    void order_end(double now, frame::Commands& commands) const noexcept;
    void order(double now, frame::Commands& commands) const noexcept;
    /// Uses typed keys, clicks or the position of the hands as answers to the questions of the
    /// state.
    void take_answers(std::span<const frame::Handle> handles, const Input& input,
                      double now) noexcept;

    /// Gives the commands of this tick, except looks, sounds and texts.
    void direct(const frame::Frame& last, std::span<const frame::Handle> handles, double now,
                frame::Commands& commands) noexcept;
    /// Commands the texts that follow the message, or the page shown in place of the texts.
    void say(double now, frame::TaskFrame& out) const noexcept;
    void say(int message, double now, frame::TaskFrame& out) const noexcept;
    /// Returns the current value of a number used in a text, or NaN if it has none.
    double value_of(Figure figure, double now) const noexcept;
    double countdown(double now) const noexcept;

    /// Skips trials whose procedure or block is already done, since either may need fewer trials
    /// than are listed.
    void skip_done() noexcept;
    bool is_done() noexcept;
    /// Determines the numbers of the trial that starts, and resolves its formulas.
    void resolve() noexcept;
    double level() const noexcept;
    double share_of_trial() const noexcept;
    void take_answer(int outcome) noexcept;

    const TaskPlan& plan_;
    double tick_;
    std::vector<Procedure> procedures_;
    TrialQueue queue_;
    TrialNumbers numbers_;
    std::vector<frame::VariableFrame> variables_;
    /// How far the condition of an exit has been met.
    struct Judged {
        double since = -1;  // time since which the condition has held [s]; -1 if it does not hold
        bool met = false;   // whether the condition has held long enough since then
        int count = 0;      // number of times that the condition has been met in this state
    };
    /// Where in a trial the task is.
    struct Current {
        bool begun = false;      // whether the trial's numbers have been resolved
        int state = -1;          // index of the current state; -1 between trials
        double trial_began = 0;  // time at which the trial's first state was entered [s]
        double entered = 0;      // time at which the current state was entered [s]
        std::vector<Judged> judged;
    };
    Current current_;
    /// The last trial that ended, counted from 1; 0 if none has ended yet.
    struct LastEnded {
        int trial = 0;
        int attempt = 0;
    };
    LastEnded last_;
    Messages messages_;
    Placer placer_;
    Motions motions_;
    // for each perturbation, the time at which its states were entered from other states [s]
    std::vector<double> began_;
    Answering answering_;
    Displayer displayer_;
    Sounder sounder_;
    Opening opening_;
    Deciding deciding_;
    Inputs inputs_;
    Rules rules_;
    std::atomic<double> share_{0};
};

}  // namespace dihaptic::task
