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
#include "recording/remarks.h"
#include "recording/showings.h"
#include "session/knob_turner.h"
#include "session/listeners/listener.h"
#include "task/run/answering.h"

namespace dihaptic::session {

/// One sample of the curves. Samples are taken even from frames that a slow screen never shows.
struct CurveSample {
    static constexpr size_t kFingers = 8;  ///< additional fingers have no curve

    double time = 0;                         ///< [s]
    double grip_force = 0;                   ///< [N]
    double load_force = 0;                   ///< [N]
    std::array<double, kFingers> forces{};   ///< force sent to the handle of each finger [N]
    std::array<double, kFingers> heights{};  ///< height of each finger's handle [m]
    double object_height = kUnmeasured;      ///< height of the origin of the object [m]
};

/// An attempt at a trial, reported when it ends.
struct TrialEnd {
    static constexpr size_t kNumbers = 8;  ///< additional numbers are left out

    int32_t trial = 0;
    int32_t attempt = 0;
    int32_t outcome = -1;
    double start = 0;       ///< [s]
    double stop = 0;        ///< [s]
    double peak_grip = 0;   ///< [N]
    double peak_force = 0;  ///< largest force sent to any finger [N]
    /// Values of the task's variables, levels of procedures, and answers, in this order. Unused
    /// elements are NaN.
    std::array<double, kNumbers> numbers{};
};

class Live : public Listener {
  public:
    /// Shortest interval between published frames; no screen is faster.
    static constexpr Time kInterval = std::chrono::milliseconds(4);
    /// Shortest interval between samples of the curves.
    static constexpr Time kCurveInterval = std::chrono::milliseconds(10);

    Latest<frame::Frame> frame;  ///< the newest frame; `sequence` is -1 before the first frame
    /// If set before the session starts, also receives the newest frame, for a second thread such
    /// as a headset's.
    std::shared_ptr<Latest<frame::Frame>> second;
    /// While true, session time stands still. On the real clock, force is off from the next tick
    /// on, and a trial interrupted by the pause starts again.
    std::atomic<bool> paused{false};
    std::atomic<double> pace{
        1};  ///< virtual clock only: ratio of session time to wall time; 0: unlimited
    std::atomic<int> steps{0};       ///< virtual clock only: number of ticks to run despite a pause
    std::atomic<bool> ended{false};  ///< requests that the session end in an orderly way
    std::atomic<bool> skip{false};   ///< requests that the running trial end in the next tick
    /// A click on a line of a question, stored until a tick handles it.
    std::atomic<task::Click> clicked{task::Click{}};
    std::atomic<double> done{0};  ///< fraction of the trials that are complete
    KnobTurner knobs;

    Live() {
        for (frame::Frame& value : frame.values()) value.sequence = -1;
    }
    /// Must be called before the first tick. Reserves memory for the frames of this servo and
    /// scene.
    void prepare(const servo::Servo& servo, const scene::Scene& scene);
    /// Passes on the requests of the watching thread. On the virtual clock, a pause stops the
    /// session (see Pacing), and no person's hand is at risk.
    void steer(const Steering& steering) noexcept override;
    /// Publishes the frame and a sample of the curves when they are due.
    void take(const frame::Frame& now) noexcept override;
    bool ends() const noexcept override { return ended.load(std::memory_order_relaxed); }
    /// Removes and returns the oldest sample not yet taken.
    std::optional<CurveSample> take_sample() { return samples_.pop(); }

    /// Removes and returns the oldest end of a trial not yet taken.
    std::optional<TrialEnd> take_trial_end() { return trial_ends_.pop(); }

    using Clock = std::chrono::steady_clock;
    /// Called by the watching thread to show that it is still running: if this thread hangs, so
    /// does every key that switches force off. After the first call, calls must continue. Force is
    /// switched off when the next call is overdue by more than kLongestSilence or, after a call
    /// with `more`, by more than kLongestSilence + `more` [s].
    void note_alive(double more = 0) noexcept {
        const Clock::time_point last = Clock::now() + from_seconds(more);
        alive_.store(last.time_since_epoch().count(), std::memory_order_relaxed);
    }
    static constexpr double kLongestSilence = 1;  // [s]
    /// Called in the tick: time for which the watching thread has been silent, if that is too long;
    /// otherwise 0 [s].
    double abandoned() const noexcept;

    /// Called from the session's thread: reports why the session paused by itself, and the remedy.
    /// Sets `paused`; the session continues when the watching thread clears `paused`.
    void tell(const std::string& why);
    /// Returns the text passed to tell() since the last call; "" if there is none.
    std::string take_told();

    /// Called from the session's thread before the first tick: sets the folder of the session's
    /// recording.
    void set_folder(const std::string& folder);
    /// Returns the folder once; "" before it is set and in all later calls.
    std::string take_folder();

    /// Called from the window's thread: the picture of a tick was passed to the screen at time
    /// `at`.
    void note_shown(int64_t tick, Clock::time_point at) noexcept;
    /// Like the other note_shown(), for a picture shown in a headset or on a screen with eye
    /// tracking. `X_WV` is the head's pose at that time (see HeadSeen). `tracked` states whether
    /// the pose was measured, not guessed.
    void note_shown(int64_t tick, Clock::time_point at, const Pose& X_WV, bool tracked) noexcept;
    /// Removes and returns the oldest showing not yet taken. Must be called from only one other
    /// thread.
    std::optional<recording::Showing> take_showing() { return showings_.pop(); }
    std::optional<recording::HeadSeen> take_head() { return heads_.pop(); }

    /// Called from the window's thread: a note of the operator, to be recorded. Returns false if
    /// the last tick is over, when nothing can be added to the recording.
    bool add_remark(recording::Remark remark);
    /// Removes and returns the notes not yet taken; after `close`, no more are accepted. To be
    /// called from the threads that write the session's files.
    std::vector<recording::Remark> take_remarks(bool close);

  private:
    void note_zero(Time now) noexcept;
    double session_time(Clock::time_point at) const noexcept;
    void note_trial(const frame::Frame& now) noexcept;

    static constexpr Clock::rep kNever = 0;
    std::atomic<Clock::rep> alive_{kNever};  // time of the last note_alive() plus its `more`

    std::mutex told_guard_;  // guards the following, which no tick touches
    std::string told_;
    std::string folder_;
    std::vector<recording::Remark> remarks_;
    bool remarks_closed_ = false;

    std::atomic<Clock::rep> zero_{
        std::numeric_limits<Clock::rep>::max()};    // when session time was zero
    ValueRing<recording::Showing> showings_{4000};  // one minute of showings
    ValueRing<recording::HeadSeen> heads_{4000};
    int64_t shown_tick_ = -1;              // last tick shown in a headset; window's thread only
    ValueRing<CurveSample> samples_{400};  // if the window hangs for longer, its curves have a gap
    ValueRing<TrialEnd> trial_ends_{400};
    TrialEnd trial_;  // the attempt that is running
    int object_ = -1;
    Time shown_{0};
    Time sampled_{0};
};

}  // namespace dihaptic::session
