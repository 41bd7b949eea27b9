// The director of a session (frame/orders.h): in each tick it gives the orders of the trials or,
// without trials, of the phases, together with those of the operator, the simulated hand, the
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
    /// Prepares everything for the ticks, since they allocate nothing. All that the arguments refer
    /// to must outlive the director.
    SessionDirector(const Opening& session, const std::atomic<bool>& stop,
                    std::vector<Listener*> listeners);

    void operator()(const frame::Frame& last, std::span<const frame::Handle> handles,
                    frame::Commands& commands);

    /// Call between two ticks: a running trial starts again.
    void interrupt() {
        if (task_) task_->interrupt();
    }
    /// Share of the trials that are done; unset without trials. May be called from any thread.
    std::optional<double> share() const noexcept {
        return task_ ? std::optional(task_->share()) : std::nullopt;
    }
    /// States that formulas of trials were kept within their bounds; "" if none was.
    std::string bounded() const;
    bool trials_left() const noexcept { return share().value_or(1) < 1; }
    /// Number of trials that an exit left out because it ended the session.
    size_t left_out() const noexcept { return task_ ? task_->left_out() : 0; }
    /// Describes the wait that was so long that it ended the session; "" if there was none.
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
