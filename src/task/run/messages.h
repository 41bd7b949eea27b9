// Which message a task shows, and which feedback. Feedback takes the message's place, unless the
// task shows it beside the message; a message that comes during feedback is shown after it.
#pragma once

#include <utility>

namespace dihaptic::task {

class Messages {
  public:
    /// `beside`: whether feedback is shown in the line below the message.
    explicit Messages(bool beside) : beside_(beside) {}

    /// Must be called in each tick.
    void tick(double now) noexcept {
        if (now >= until_ && next_ >= 0) message_ = std::exchange(next_, -1);
    }
    void show(int message, double now) noexcept {
        (now < until_ && !beside_ ? next_ : message_) = message;
    }
    /// Shows a message at once.
    void interrupt(int message) noexcept { message_ = message; }
    /// Stops showing this message.
    void withdraw(int message) noexcept {
        if (message_ == message) message_ = -1;
    }
    /// Shows feedback until the time `until` [s].
    void give_feedback(int feedback, double until) noexcept {
        (beside_ ? feedback_ : message_) = feedback;
        next_ = -1;
        until_ = until;
    }
    /// Shows a message like feedback, but in the message's place.
    void announce(int message, double until) noexcept {
        message_ = message;
        next_ = -1;
        until_ = until;
    }
    bool shows_feedback(double now) const noexcept { return now < until_; }
    /// Index of the message that is shown; -1 for none.
    int message() const noexcept { return message_; }
    /// Index of the feedback in the line below the message; -1 for none.
    int line(double now) const noexcept { return shows_feedback(now) ? feedback_ : -1; }

  private:
    bool beside_;
    int message_ = -1;
    int next_ = -1;      // message to be shown after the feedback
    int feedback_ = -1;  // feedback in the line below the message
    double until_ = -1;  // time until which feedback is shown [s]
};

}  // namespace dihaptic::task
