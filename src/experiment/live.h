// A running session's link to whoever watches and steers it from another thread, e.g. a window.
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

/// What curves are drawn of: frames that a slow screen never shows are among them.
struct CurveSample {
    static constexpr size_t kFingers = 8;  ///< those beyond are left out

    double time = 0;                         ///< [s]
    double grip_force = 0;                   ///< [N]
    double load_force = 0;                   ///< [N]
    std::array<double, kFingers> forces{};   ///< on the handle, as sent, by finger [N]
    std::array<double, kFingers> heights{};  ///< of the handle, by finger [m]
    double object_height = kUnmeasured;      ///< of the object's origin [m]
};

struct Live {
    /// How often a frame is handed over, at most: a screen shows no more.
    static constexpr Time kInterval = std::chrono::milliseconds(4);
    /// And a sample of curves.
    static constexpr Time kCurveInterval = std::chrono::milliseconds(10);

    Latest<servo::Frame> frame;  ///< the newest; its `sequence` is -1 before the first
    /// As long as it is, time stands still and no force acts, from the next tick on. A trial that
    /// it interrupts begins anew.
    std::atomic<bool> paused{false};
    std::atomic<bool> ended{false};  ///< the session is to end, in order
    std::atomic<bool> skip{false};   ///< the trial that runs is to end, in the next tick
    std::atomic<double> done{0};     ///< share of the trials that are over
    Latest<std::optional<dynamics::Solver>> solver;  ///< from the next step on
    /// To be had soon: stiffness and damping go there in kEase, so that what is held stays held.
    Latest<std::optional<haptics::Tuning>> tuning;
    static constexpr double kEase = 0.2;  // [s]
    /// What fingers are, where settings.proxy.changeable: from when all are clear of everything,
    /// so that none lets go of what it holds, or pushes away what it is put into.
    Latest<std::optional<haptics::ProxyKind>> proxy;
    /// Every coefficient of friction times so much; unset: as the session has them.
    Latest<std::optional<double>> friction_scale;
    /// Angle that the workspaces turn to, as servo::WorkspaceTurn has it [rad].
    Latest<double> workspace;

    Live() {
        for (servo::Frame& value : frame.values()) value.sequence = -1;
    }
    /// Before the first tick: memory for the frames of this servo, of this scene.
    void prepare(const servo::Servo& servo, const scene::Scene& scene);
    /// In the tick: the kind of proxy that may be had now.
    std::optional<haptics::ProxyKind> change_proxy(const servo::Frame& last) noexcept;
    /// In the tick: hands over what is due again.
    void show(const servo::Frame& now) noexcept;
    /// In the tick: what the coupling is to be in this one. `now`: in the last; `h`: a tick [s].
    std::optional<haptics::Tuning> tune(const haptics::Tuning& now, double h) noexcept;
    /// In the tick: the rate at which the workspaces turn from now on [rad/s]. `h`: a tick [s].
    double turn(const servo::Frame& last, double h) noexcept {
        return servo::WorkspaceTurn::rate_toward(workspace.read(),
                                                 last.workspace_turn + h * last.workspace_rate);
    }
    /// The oldest sample that was not taken yet.
    std::optional<CurveSample> take_sample() { return samples_.pop(); }

    using Clock = std::chrono::steady_clock;
    /// Whoever watches may hang, and with it every key that switches force off: once it has called
    /// this it must go on to, and force is off when it has not for longer than kLongestSilence, and
    /// this once for longer than `more` beyond that [s].
    void note_alive(double more = 0) noexcept {
        const Clock::time_point last = Clock::now() + from_seconds(more);
        alive_.store(last.time_since_epoch().count(), std::memory_order_relaxed);
    }
    static constexpr double kLongestSilence = 1;  // [s]
    /// In the tick: how long whoever watches has been silent, if that is too long; otherwise 0 [s].
    double abandoned() const noexcept;

    /// From the session's thread: why it paused by itself, and what to do. `paused` is set then;
    /// whoever takes it back lets the session go on.
    void tell(const std::string& why);
    /// What was told since the last call; "": nothing.
    std::string take_told();

    /// From the window's thread: the picture of a tick was handed to the screen at `at`.
    void note_shown(int64_t tick, Clock::time_point at) noexcept;
    /// From one other thread: the oldest showing that was not taken yet.
    std::optional<recording::Showing> take_showing() { return showings_.pop(); }

  private:
    void note_zero(Time now) noexcept;

    static constexpr Clock::rep kNever = 0;
    std::atomic<Clock::rep> alive_{
        kNever};  // when note_alive() was called last, and what more it gave

    std::mutex told_guard_;
    std::string told_;

    std::atomic<Clock::rep> zero_{std::numeric_limits<Clock::rep>::max()};  // of session time
    ValueRing<recording::Showing> showings_{4000};                          // a minute
    ValueRing<CurveSample> samples_{400};  // a window that hangs for longer has a gap in its curves
    int object_ = -1;
    Clearance clearance_;
    haptics::Tuning tuning_goal_;
    double left_ = 0;  // until it is reached [s]
    Time shown_{0};
    Time sampled_{0};
};

}  // namespace dihaptic::experiment
