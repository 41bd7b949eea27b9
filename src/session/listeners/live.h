// The link between a running session and the thread that watches and steers it, e.g. a window.
#pragma once

#include <array>
#include <atomic>
#include <memory>
#include <mutex>
#include <optional>
#include <vector>

#include "base/latest.h"
#include "base/ring.h"
#include "recording/heads.h"
#include "recording/showings.h"
#include "session/knob_turner.h"
#include "session/listeners/listener.h"
#include "task/run/answering.h"

namespace dihaptic::session {

/// One sample of the curves. Samples also come from frames that a slow screen never shows.
struct CurveSample {
    static constexpr size_t kFingers = 8;  ///< further fingers have no curve

    double time = 0;                         ///< [s]
    double grip_force = 0;                   ///< [N]
    double load_force = 0;                   ///< [N]
    std::array<double, kFingers> forces{};   ///< force sent to the handle, by finger [N]
    std::array<double, kFingers> heights{};  ///< height of the handle, by finger [m]
    double object_height = kUnmeasured;      ///< height of the object's origin [m]
};

/// An attempt at a trial that has just ended.
struct TrialEnd {
    static constexpr size_t kNumbers = 8;  ///< further numbers are left out

    int32_t trial = 0;
    int32_t attempt = 0;
    int32_t outcome = -1;
    double start = 0;       ///< [s]
    double stop = 0;        ///< [s]
    double peak_grip = 0;   ///< [N]
    double peak_force = 0;  ///< largest force sent to any finger [N]
    /// Values of the task's variables, levels of procedures, and answers, in this order; NaN after
    /// the last.
    std::array<double, kNumbers> numbers{};
};

class Live : public Listener {
  public:
    /// Shortest time between frames handed over: screens are no faster.
    static constexpr Time kInterval = std::chrono::milliseconds(4);
    /// Shortest time between samples of the curves.
    static constexpr Time kCurveInterval = std::chrono::milliseconds(10);

    Latest<frame::Frame> frame;  ///< the newest frame; its `sequence` is -1 before the first one
    /// If set before the session starts: the frame for a second thread, such as a headset's.
    std::shared_ptr<Latest<frame::Frame>> second;
    /// While set, time stands still. On the real clock no force acts, from the next tick on, and a
    /// trial interrupted by a pause starts again.
    std::atomic<bool> paused{false};
    std::atomic<double> pace{
        1};  ///< virtual clock: session time over wall time; 0: as fast as possible
    std::atomic<int> steps{0};       ///< virtual clock: ticks to perform despite a pause
    std::atomic<bool> ended{false};  ///< requests an orderly end of the session
    std::atomic<bool> skip{false};   ///< requests the end of the running trial in the next tick
    /// A click on a question's line, until a tick takes it.
    std::atomic<task::Click> clicked{task::Click{}};
    std::atomic<double> done{0};  ///< share of completed trials
    KnobTurner knobs;

    Live() {
        for (frame::Frame& value : frame.values()) value.sequence = -1;
    }
    /// Call before the first tick: reserves memory for the frames of this servo and scene.
    void prepare(const servo::Servo& servo, const scene::Scene& scene);
    /// Passes on what the watching thread requests. On the virtual clock the session stands still
    /// in a pause (Pacing), and no person's hand is at risk.
    void steer(const Steering& steering) noexcept override;
    /// Hands over a frame and a sample when they are due.
    void take(const frame::Frame& now) noexcept override;
    bool ends() const noexcept override { return ended.load(std::memory_order_relaxed); }
    /// The oldest sample not yet taken.
    std::optional<CurveSample> take_sample() { return samples_.pop(); }

    /// The oldest end of a trial not yet taken.
    std::optional<TrialEnd> take_trial_end() { return trial_ends_.pop(); }

    using Clock = std::chrono::steady_clock;
    /// The watching thread may hang, and with it every key that switches force off. After its first
    /// call it must keep calling this function: force is switched off when a call is more than
    /// kLongestSilence overdue, or, once, more than kLongestSilence + `more` [s].
    void note_alive(double more = 0) noexcept {
        const Clock::time_point last = Clock::now() + from_seconds(more);
        alive_.store(last.time_since_epoch().count(), std::memory_order_relaxed);
    }
    static constexpr double kLongestSilence = 1;  // [s]
    /// In the tick: duration of the watching thread's silence, if too long; otherwise 0 [s].
    double abandoned() const noexcept;

    /// From the session's thread: gives the reason why it paused by itself, and the remedy. Sets
    /// `paused`; the session continues when the watching thread clears it.
    void tell(const std::string& why);
    /// The text from tell() since the last call; "" if none.
    std::string take_told();

    /// From the session's thread: the folder of its recording, before its first tick.
    void set_folder(const std::string& folder);
    /// The folder; "" before it is set, and after the first call that returned it.
    std::string take_folder();

    /// From the window's thread: the picture of a tick was handed to the screen at `at`.
    void note_shown(int64_t tick, Clock::time_point at) noexcept;
    /// A picture shown in a headset, or on a screen to tracked eyes. `X_WV`: pose of the head at
    /// that time, see HeadSeen. `tracked`: the pose was measured, not guessed.
    void note_shown(int64_t tick, Clock::time_point at, const Pose& X_WV, bool tracked) noexcept;
    /// From one other thread: the oldest showing not yet taken.
    std::optional<recording::Showing> take_showing() { return showings_.pop(); }
    std::optional<recording::HeadSeen> take_head() { return heads_.pop(); }

  private:
    void note_zero(Time now) noexcept;
    double session_time(Clock::time_point at) const noexcept;
    void note_trial(const frame::Frame& now) noexcept;

    static constexpr Clock::rep kNever = 0;
    std::atomic<Clock::rep> alive_{kNever};  // time of the last note_alive(), plus its `more`

    std::mutex told_guard_;  // guards both
    std::string told_;
    std::string folder_;

    std::atomic<Clock::rep> zero_{
        std::numeric_limits<Clock::rep>::max()};    // zero of the session's clock
    ValueRing<recording::Showing> showings_{4000};  // one minute of showings
    ValueRing<recording::HeadSeen> heads_{4000};
    int64_t shown_tick_ = -1;              // used by the window's thread: last tick in a headset
    ValueRing<CurveSample> samples_{400};  // if the window hangs for longer, its curves have a gap
    ValueRing<TrialEnd> trial_ends_{400};
    TrialEnd trial_;  // the running attempt
    int object_ = -1;
    Time shown_{0};
    Time sampled_{0};
};

}  // namespace dihaptic::session
