// The director of a session (frame/orders.h). In each tick it combines the orders of the trials
// (or, if there are no trials, of the phases) with those of the operator, the simulated hand, the
// triggers and the watching thread.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "session/listeners/listener.h"
#include "session/phase_director.h"
#include "session/session_run.h"
#include "session/wait.h"
#include "task/run/task_director.h"

namespace dihaptic::session {

class SessionDirector {
  public:
    /// Prepares everything that the ticks need, since ticks do not allocate memory. All objects to
    /// which the arguments refer must outlive the director.
    SessionDirector(const Opening& session, const std::atomic<bool>& stop,
                    std::vector<Listener*> listeners);

    void operator()(const frame::Frame& last, std::span<const frame::Handle> handles,
                    frame::Commands& commands);

    /// Must be called between two ticks; makes a running trial start again.
    void interrupt() {
        if (task_) task_->interrupt();
    }
    /// Fraction of the trials that are done; unset if there are no trials. May be called from any
    /// thread.
    std::optional<double> share() const noexcept {
        return task_ ? std::optional(task_->share()) : std::nullopt;
    }
    /// States which trial formulas were limited to their bounds; "" if none were.
    std::string bounded() const;
    bool trials_left() const noexcept { return share().value_or(1) < 1; }
    /// Number of trials that were left out because a transition ended the session.
    size_t left_out() const noexcept { return task_ ? task_->left_out() : 0; }
    /// Describes placements that did not take place; "" if all did.
    std::string missed_placements() const;
    /// Describes the wait that ended the session because it took too long; "" if there was none.
    std::string endless_wait(const std::vector<recording::PhaseInfo>& phases) const;

  private:
    void direct_task(const frame::Frame& last, std::span<const frame::Handle> handles,
                     frame::Commands& commands);
    void be_steered(const frame::Frame& last, frame::Commands& commands);

    const Plan& plan_;
    const RunOptions& options_;
    const std::atomic<bool>& stop_;
    const servo::Servo& servo_;
    const bool real_;
    const std::vector<Listener*> listeners_;
    PhaseDirector phases_;
    std::optional<task::TaskDirector> task_;
    std::optional<Wait> wait_;
};

}  // namespace dihaptic::session
