// Runs a session's trials inside the tick: tracks the current state, orders its display and
// perturbations, evaluates its exits, and chooses the next trial. Once constructed, it neither
// allocates, locks nor throws.
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
    /// `plan` must outlive the director. `done`: attempts in an earlier part of the session, in
    /// order.
    TaskDirector(const TaskPlan& plan, uint64_t seed, double tick,
                 const std::vector<Attempt>& done = {});

    void operator()(const frame::Frame& last, std::span<const frame::Handle> handles,
                    frame::Commands& commands) noexcept;

    /// Queues a key that the operator pressed, for a tick to take. Call from one thread only.
    void press(char key) noexcept { keys_.push(key); }
    /// Forwards a click on the line of a question. May be called from any thread.
    void click(const Click& click) noexcept { clicked_.store(click, std::memory_order_relaxed); }
    /// Forwards an external trigger. `code`: 1 to 255, or kAnyTrigger. May be called from any
    /// thread.
    void trigger(int code) noexcept { trigger_.store(code, std::memory_order_relaxed); }
    static constexpr int kAnyTrigger = -1;  ///< matches every expected code
    /// Ends the trial in the next tick as skipped, without repetition. May be called from any
    /// thread.
    void skip() noexcept { skip_.store(true, std::memory_order_relaxed); }
    /// Makes the director ask `between`, which must outlive the director, before each attempt. Call
    /// before the first tick.
    void decide_by(TrialControl& between) noexcept;
    /// Restarts a running trial. Call between two ticks.
    void interrupt() noexcept {
        if (!queue_.empty() && state_ >= 0) queue_.again();
        state_ = -1;
        begun_ = false;
        for (Taken& taken : taken_) taken.clear();
        motions_.forget();
    }
    /// The numbers of the trials so far, with a record of formulas that had to be kept within
    /// bounds.
    const TrialNumbers& numbers() const noexcept { return numbers_; }
    /// A finger that keeps a body from being placed at its start pose. Call between ticks.
    struct Obstacle {
        int body = -1;    ///< -1: no obstacle so far
        int finger = -1;  ///< -1: a finger presses the body
    };
    Obstacle obstacle() const noexcept { return obstacle_; }
    /// Number of trials that an exit left out because it ended the session.
    size_t left_out() const noexcept { return queue_.left_out(); }
    /// Share of completed trials. May be called from any thread.
    double share() const noexcept { return share_.load(std::memory_order_relaxed); }

  private:
    const Trial& trial() const { return plan_.trials[static_cast<size_t>(queue_.trial())]; }
    bool clear(const frame::Frame& last) noexcept;
    bool clear(const frame::Frame& last, const TaskPlan::StartPose& start_pose,
               const Pose& X_WB) noexcept;
    void put(int body, const Pose& X_WB, const BodyMotion& motion,
             frame::Commands& commands) noexcept;
    /// Starts the next trial once the last feedback and the block's pages are over and bodies can
    /// be placed at their start poses.
    void begin(const frame::Frame& last, char key, double now, frame::Commands& commands) noexcept;
    /// Asks the program that decides about the next attempt, if there is one.
    void ask(int attempt, int outcome, double now) noexcept;
    /// Whether that program has answered or is too late.
    bool decided(double now) noexcept;
    void follow(const Decision& decision, double now) noexcept;
    void enter(int state, double now, frame::Commands& commands) noexcept;
    /// External input since the last tick.
    struct Input {
        char key;     // 0: none
        int trigger;  // 0: none
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
    /// Uses typed keys, clicks or the position of the hands as answers to the state's questions.
    void take_answers(std::span<const frame::Handle> handles, const Input& input,
                      double now) noexcept;

    /// Like operator(), but without looks, sounds and texts.
    void direct(const frame::Frame& last, std::span<const frame::Handle> handles, double now,
                frame::Commands& commands) noexcept;
    /// Orders the texts after the message, or the page shown in place of them.
    void say(double now, frame::TaskFrame& out) const noexcept;
    void say(int message, double now, frame::TaskFrame& out) const noexcept;
    /// Current value of a number in a text; NaN if there is none.
    double value_of(Figure figure, double now) const noexcept;
    double countdown(double now) const noexcept;

    /// Skips trials whose procedure or block is done: either may need fewer trials than are listed.
    void skip_done() noexcept;
    bool is_done() noexcept;
    /// Applies the rules to the variables at the end of a trial.
    void follow_rules(int outcome, bool redo) noexcept;
    void take_measures(const frame::Frame& last) noexcept;
    void look_back(size_t from, size_t to, bool counts) noexcept;
    /// Chooses the numbers of the starting trial, and resolves its formulas.
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
    bool begun_ = false;      // the trial's numbers are resolved
    int state_ = -1;          // -1: between trials
    double trial_began_ = 0;  // time of entry into the trial's first state [s]
    double entered_ = 0;      // time of entry into the state [s]
    int message_ = -1;
    int next_message_ = -1;       // shown after the feedback
    int feedback_ = -1;           // line below the message
    double feedback_until_ = -1;  // end of the feedback [s]
    int last_trial_ = 0;          // last trial that ended, from 1; 0: none yet
    int last_attempt_ = 0;
    /// State of an exit's condition.
    struct Judged {
        double since = -1;  // time since which the condition has held [s]; -1: it does not hold
        bool met = false;   // the condition has held long enough since then
        int count = 0;      // number of times that the condition was met in the state
    };
    std::vector<Judged> judged_;
    std::vector<char> is_put_;        // by placement in the state: whether the body has been placed
    std::vector<Pose> put_at_;        // by placement: pose of its body
    std::vector<Pose> drive_from_;    // by drive: pose of its body at the state's start
    std::vector<double> motor_from_;  // by motor: coordinate of its joint at the state's start
    bool driving_ = false;            // drive_from_ and motor_from_ are valid for this state
    Motions motions_;
    // by perturbation: time of entry into its states from other states [s]
    std::vector<double> began_;
    Answering answering_;
    Displayer displayer_;
    Sounder sounder_;
    Opening opening_;
    TrialControl* between_ = nullptr;
    bool asked_ = false;    // asked, but no decision yet
    double ask_until_ = 0;  // time limit for the decision [s]
    ValueRing<char> keys_{kMostKeys};
    std::atomic<Click> clicked_{Click{}};
    std::vector<Taken> taken_;                  // one for each measure that rules name
    std::vector<double> in_frame_;              // quantities in the last Frame
    std::vector<frame::Handle> frame_handles_;  // handles in the last Frame
    /// Values at the ends of the last trials, by look-back.
    struct Past {
        std::vector<double> values;  // a ring, filled from the beginning
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
