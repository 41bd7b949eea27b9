// Runs the trials of a session, tick by tick: tracks the current state, commands its display and
// perturbations, evaluates its exits, and chooses the next trial. After construction, the director
// does not allocate, lock or throw.
#pragma once

#include <atomic>

#include "base/ring.h"
#include "base/unmeasured.h"
#include "frame/orders.h"
#include "task/plan/taken.h"
#include "task/run/answering.h"
#include "task/run/displayer.h"
#include "task/run/opening.h"
#include "task/run/sounder.h"
#include "task/run/trial_control.h"
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
    void press(char key) noexcept { keys_.push(key); }
    /// Passes on a click on the line of a question. May be called from any thread.
    void click(const Click& click) noexcept { clicked_.store(click, std::memory_order_relaxed); }
    /// Passes on an external trigger. `code` is 1 to 255, or kAnyTrigger. May be called from any
    /// thread.
    void trigger(int code) noexcept { trigger_.store(code, std::memory_order_relaxed); }
    static constexpr int kAnyTrigger = -1;  ///< a trigger that matches every expected code
    /// Ends the trial as skipped in the next tick. The trial is not repeated. May be called from
    /// any thread.
    void skip() noexcept { skip_.store(true, std::memory_order_relaxed); }
    /// Makes the director ask `between` for a decision before each attempt. `between` must outlive
    /// the director. Must be called before the first tick.
    void decide_by(TrialControl& between) noexcept;
    /// Restarts a running trial. Must be called between two ticks.
    void interrupt() noexcept {
        if (!queue_.empty() && state_ >= 0) queue_.again();
        state_ = -1;
        begun_ = false;
        for (Taken& taken : taken_) taken.clear();
        motions_.forget();
    }
    /// The numbers in the trials so far, including a record of formulas that had to be kept within
    /// bounds.
    const TrialNumbers& numbers() const noexcept { return numbers_; }
    /// What keeps a body from being placed at its start pose. Must be called between ticks.
    struct Obstacle {
        int body = -1;    ///< index of the body; -1 if there has been no obstacle so far
        int finger = -1;  ///< index of the finger in the way; -1 if a finger presses the body
    };
    Obstacle obstacle() const noexcept { return obstacle_; }
    /// Number of trials that were left out because an exit ended the session.
    size_t left_out() const noexcept { return queue_.left_out(); }
    /// Share of trials that have been completed. May be called from any thread.
    double share() const noexcept { return share_.load(std::memory_order_relaxed); }

  private:
    const Trial& trial() const { return plan_.trials[static_cast<size_t>(queue_.trial())]; }
    bool clear(const frame::Frame& last) noexcept;
    bool clear(const frame::Frame& last, const TaskPlan::StartPose& start_pose,
               const Pose& X_WB) noexcept;
    void put(int body, const Pose& X_WB, const BodyMotion& motion,
             frame::Commands& commands) noexcept;
    /// Starts the next trial once the last feedback and the block's pages are over and the bodies
    /// can be placed at their start poses.
    void begin(const frame::Frame& last, char key, double now, frame::Commands& commands) noexcept;
    /// Asks the program that decides about the next attempt for its decision, if there is such a
    /// program.
    void ask(int attempt, int outcome, double now) noexcept;
    /// Whether the program that decides about the next attempt has answered or is too late.
    bool decided(double now) noexcept;
    void follow(const Decision& decision, double now) noexcept;
    void enter(int state, double now, frame::Commands& commands) noexcept;
    /// External input since the last tick.
    struct Input {
        char key;     // 0 if there is none
        int trigger;  // 0 if there is none
        Click clicked;
    };
    bool holds(const TaskPlan::Transition& transition, const frame::Frame& last,
               const Input& input) const noexcept;
    const TaskPlan::Transition* transition_taken(const frame::Frame& last, const Input& input,
                                                 double now) noexcept;
    void finish(int outcome, bool redo, double now, frame::Commands& commands) noexcept;
    void order_end(double now, frame::Commands& commands) const noexcept;
    void order(double now, frame::Commands& commands) const noexcept;
    void put_bodies(const frame::Frame& last, frame::Commands& commands) noexcept;
    void drive_bodies(const frame::Frame& last, double now, frame::Commands& commands) noexcept;
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
    /// Updates the variables at the end of a trial, according to the rules.
    void follow_rules(int outcome, bool redo) noexcept;
    void take_measures(const frame::Frame& last) noexcept;
    void look_back(size_t from, size_t to, bool counts) noexcept;
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
    bool begun_ = false;      // whether the trial's numbers have been resolved
    int state_ = -1;          // index of the current state; -1 between trials
    double trial_began_ = 0;  // time at which the trial's first state was entered [s]
    double entered_ = 0;      // time at which the current state was entered [s]
    int message_ = -1;
    int next_message_ = -1;       // message to be shown after the feedback
    int feedback_ = -1;           // feedback in the line below the message
    double feedback_until_ = -1;  // time until which feedback is shown [s]
    // number of the last trial that ended, counted from 1; 0 if none has ended yet
    int last_trial_ = 0;
    int last_attempt_ = 0;
    /// How far the condition of an exit has been met.
    struct Judged {
        double since = -1;  // time since which the condition has held [s]; -1 if it does not hold
        bool met = false;   // whether the condition has held long enough since then
        int count = 0;      // number of times that the condition has been met in this state
    };
    std::vector<Judged> judged_;
    std::vector<char> is_put_;  // for each placement in the state, whether the body has been placed
    std::vector<Pose> put_at_;  // for each placement, the pose of its body
    // for each drive, the pose of its body at the start of the state
    std::vector<Pose> drive_from_;
    // for each motor, the coordinate of its joint at the start of the state
    std::vector<double> motor_from_;
    bool driving_ = false;  // whether drive_from_ and motor_from_ are valid for this state
    Motions motions_;
    // for each perturbation, the time at which its states were entered from other states [s]
    std::vector<double> began_;
    Answering answering_;
    Displayer displayer_;
    Sounder sounder_;
    Opening opening_;
    TrialControl* between_ = nullptr;
    bool asked_ = false;    // whether a decision has been asked for and is still awaited
    double ask_until_ = 0;  // time until which the decision is awaited [s]
    ValueRing<char> keys_{kMostKeys};
    std::atomic<Click> clicked_{Click{}};
    std::vector<Taken> taken_;                  // one for each measure used in rules
    std::vector<double> in_frame_;              // quantities in the last Frame
    std::vector<frame::Handle> frame_handles_;  // handles in the last Frame
    /// The values of a look-back's expression at the ends of the last trials.
    struct Past {
        std::vector<double> values;  // ring buffer, filled from the beginning
        std::vector<double> sorted;
        size_t next = 0;
        double best = kUnmeasured;
    };
    std::vector<Past> past_;
    Obstacle obstacle_;
    std::atomic<int> trigger_{0};
    std::atomic<bool> skip_{false};
    std::atomic<double> share_{0};
};

}  // namespace dihaptic::task
