// The link between a running session and the thread that watches and steers it, e.g. a window.
#pragma once

#include <array>
#include <atomic>
#include <mutex>
#include <optional>
#include <vector>

#include "base/latest.h"
#include "base/ring.h"
#include "experiment/clearance.h"
#include "recording/showings.h"
#include "servo/servo.h"

namespace dihaptic::experiment {

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

struct Live {
    /// Shortest time between frames handed over: a screen shows no more.
    static constexpr Time kInterval = std::chrono::milliseconds(4);
    /// Shortest time between samples of the curves.
    static constexpr Time kCurveInterval = std::chrono::milliseconds(10);

    Latest<servo::Frame> frame;  ///< the newest; its `sequence` is -1 before the first
    /// While set, time stands still and no force acts, from the next tick on. A trial that a pause
    /// interrupts begins anew.
    std::atomic<bool> paused{false};
    std::atomic<bool> ended{false};  ///< asks the session to end in an orderly way
    std::atomic<bool> skip{false};   ///< asks the running trial to end in the next tick
    std::atomic<double> done{0};     ///< share of the trials that are over
    Latest<std::optional<dynamics::Solver>> solver;  ///< solver to use from the next step on
    /// Coupling to reach: stiffness and damping change over kEase, so that what is held stays held.
    Latest<std::optional<haptics::Tuning>> tuning;
    static constexpr double kEase = 0.2;  // [s]
    /// Kind of proxy wanted, if settings.proxy.changeable. It changes once all fingers are clear of
    /// all bodies, so that no finger lets go of what it holds or pushes away what it overlaps.
    Latest<std::optional<haptics::ProxyKind>> proxy;
    /// Factor on every coefficient of friction; unset: the session's coefficients stay.
    Latest<std::optional<double>> friction_scale;
    /// Angle that the workspaces turn to (servo::WorkspaceTurn) [rad].
    Latest<double> workspace;

    Live() {
        for (servo::Frame& value : frame.values()) value.sequence = -1;
    }
    /// Call before the first tick: reserves memory for the frames of this servo and scene.
    void prepare(const servo::Servo& servo, const scene::Scene& scene);
    /// In the tick: the kind of proxy to change to now; nullopt if none.
    std::optional<haptics::ProxyKind> change_proxy(const servo::Frame& last) noexcept;
    /// In the tick: hands over a frame and a sample when they are due.
    void show(const servo::Frame& now) noexcept;
    /// In the tick: the coupling for this tick; nullopt when it stays. `now`: the last tick's
    /// coupling; `h`: length of a tick [s].
    std::optional<haptics::Tuning> tune(const haptics::Tuning& now, double h) noexcept;
    /// In the tick: the rate at which the workspaces turn from now on [rad/s]. `h`: length of a
    /// tick [s].
    double turn(const servo::Frame& last, double h) noexcept {
        return servo::WorkspaceTurn::rate_toward(workspace.read(),
                                                 last.workspace_turn + h * last.workspace_rate);
    }
    /// The oldest sample not yet taken.
    std::optional<CurveSample> take_sample() { return samples_.pop(); }

    using Clock = std::chrono::steady_clock;
    /// The watching thread may hang, and with it every key that switches force off. After its first
    /// call it must keep calling this: force is switched off when a call is more than
    /// kLongestSilence overdue, or, for this one time, more than kLongestSilence + `more` [s].
    void note_alive(double more = 0) noexcept {
        const Clock::time_point last = Clock::now() + from_seconds(more);
        alive_.store(last.time_since_epoch().count(), std::memory_order_relaxed);
    }
    static constexpr double kLongestSilence = 1;  // [s]
    /// In the tick: how long the watching thread has been silent, if that is too long; otherwise 0
    /// [s].
    double abandoned() const noexcept;

    /// From the session's thread: tells why it paused by itself, and what to do. Sets `paused`; the
    /// session goes on when the watching thread clears it.
    void tell(const std::string& why);
    /// What tell() said since the last call; "" if nothing.
    std::string take_told();

    /// From the window's thread: the picture of a tick was handed to the screen at `at`.
    void note_shown(int64_t tick, Clock::time_point at) noexcept;
    /// From one other thread: the oldest showing not yet taken.
    std::optional<recording::Showing> take_showing() { return showings_.pop(); }

  private:
    void note_zero(Time now) noexcept;

    static constexpr Clock::rep kNever = 0;
    std::atomic<Clock::rep> alive_{kNever};  // time of the last note_alive(), plus its `more`

    std::mutex told_guard_;
    std::string told_;

    std::atomic<Clock::rep> zero_{
        std::numeric_limits<Clock::rep>::max()};    // of the session's clock
    ValueRing<recording::Showing> showings_{4000};  // a minute's worth
    ValueRing<CurveSample> samples_{400};  // a window that hangs for longer has a gap in its curves
    int object_ = -1;
    Clearance clearance_;
    haptics::Tuning tuning_goal_;
    double left_ = 0;  // time until tuning_goal_ is reached [s]
    Time shown_{0};
    Time sampled_{0};
};

}  // namespace dihaptic::experiment
