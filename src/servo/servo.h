// One tick of the servo, as an ordinary function with time as an argument. Real time, tests, batch
// runs and replay call the same one:
//
//   read the devices -> director -> fold the couplings -> step the world -> forces -> limits ->
//   write -> Frame
//
// The force that is written belongs to the positions that were read in the same tick.
#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <optional>
#include <span>

#include "haptics/finger.h"
#include "haptics/force_guard.h"
#include "haptics/safety.h"
#include "haptics/soft_start.h"
#include "rig/rig.h"
#include "servo/frame.h"
#include "servo/lateness.h"
#include "servo/settings.h"
#include "servo/workspace_turn.h"

namespace dihaptic::servo {

/// What the director wants of a tick.
struct Commands {
    int32_t trial = 0;
    int32_t phase = 0;
    bool stop = false;       ///< this tick is the last
    bool force_off = false;  ///< from this tick on, for good: the operator's wish
    bool rest = false;       ///< no force in this tick, which is the last until resume(): a pause
    /// How long whoever watches the session has not answered, if that is too long: force is off
    /// from this tick on [s].
    double abandoned = 0;
    std::optional<dynamics::Solver> solver;  ///< from this step on
    std::optional<haptics::Tuning> tuning;   ///< of all couplings, from this tick on
    /// What fingers are that may change, and that the scene gives no proxy of their own, from this
    /// tick on. Who orders it sees to it that they are clear of everything.
    std::optional<haptics::ProxyKind> proxy;
    std::optional<double> friction_scale;  ///< of every coefficient, from this tick on
    double workspace_rate = 0;             ///< of the workspaces' turn, from this tick on [rad/s]

    TaskFrame task;  ///< of this tick alone: it is empty before the director is asked
};

/// The owner's part of a tick: sees the last Frame and the handles as just read. It runs inside the
/// tick, so it must not allocate, lock or throw.
using Director = std::function<void(const Frame& last, std::span<const haptics::Handle> handles,
                                    Commands& commands)>;

/// A run goes on for so long after a fault, without force: what becomes of the objects is recorded.
constexpr Time kGrace = std::chrono::seconds(1);

class Servo {
  public:
    /// `X_WD` by device; devices, in the order of the scene's fingers. `wall`: what hands are kept
    /// in; otherwise the box that each device reaches, if it says so.
    Servo(const scene::Scene& scene, const Settings& settings,
          std::unique_ptr<devices::DeviceGroup> devices, std::vector<Pose> X_WD,
          const std::optional<Eigen::AlignedBox3d>& wall = {});
    ~Servo();

    /// Reserves all memory and switches the devices on.
    void activate();
    /// Zero force, devices off.
    void deactivate();
    /// Zero force between two ticks, for a pause; time goes on where it was, and force comes on
    /// softly.
    void rest() noexcept;
    /// After rest(), before the next tick: hands may be elsewhere by now, and force comes on
    /// softly, from zero in the next tick. After a fault the devices are activated anew, and it is
    /// forgotten; what was nowhere, in a world that diverged, is where the scene has it. Throws
    /// Error when the devices cannot be activated.
    void resume();
    /// Memory for every Frame that this servo makes; only copies into it allocate nothing.
    void reserve(Frame& frame) const;

    /// One tick at `now`; returns its Frame, valid until the next tick.
    const Frame& tick(Time now, const Director& director) noexcept;
    /// Whether the last tick's director asked to stop, a recording ended, or a fault's grace is
    /// over; the operator's wish needs none.
    bool stopped() const { return stopped_; }
    /// Whether the last tick's director asked for no more than a rest.
    bool resting() const { return resting_; }
    /// Why force is off, if it is.
    const haptics::Fault& fault() const { return faults_.fault(); }
    /// Has the devices call `tick` as devices::DeviceGroup::pace() says.
    void pace(const std::function<bool()>& tick) { devices_->pace(tick); }
    /// Force off on all devices at once, from any thread; false when they cannot.
    bool stop_devices() noexcept;
    /// Energy that a finger's coupling generated, as haptics::EnergyGuard counts it [J].
    double generated(int finger) const {
        return force_guards_[static_cast<size_t>(finger)].generated();
    }
    /// For whoever keeps real time: goes into the next Frame, and `max_late` is judged by it.
    void note_timing(double lateness, double last_tick, bool overrun) noexcept;
    /// Whether devices hold a person's hand, so that a late tick may be a fault. Otherwise it is
    /// only told.
    bool real() const { return real_; }
    /// Of handle and hand, that what a late loop holds is judged by: the least that a device tells
    /// of [N*s/m].
    double damping() const { return damping_; }

    Time period() const { return period_; }
    const Settings& settings() const { return settings_; }
    const dynamics::World& world() const { return world_; }
    dynamics::World& world() { return world_; }
    const devices::DeviceGroup& devices() const { return *devices_; }
    /// Active, and between ticks: to be read without a tick.
    devices::DeviceGroup& devices() { return *devices_; }

  private:
    void measure(Time now) noexcept;
    void judge_lateness(Time now, double elapsed) noexcept;
    /// Has the couplings give what is asked for, and no more than the loop holds.
    void retune() noexcept;
    void bound_rise(size_t finger, double share) noexcept;
    /// Bodies as ordered, proxies to their handles, and a step of the world, if it is time for one.
    dynamics::StepStatus advance_world() noexcept;
    void turn_workspaces(double rate) noexcept;
    void make_forces(Time now) noexcept;
    haptics::Finger make_finger(const scene::Scene& scene, size_t finger, dynamics::BodyIndex proxy,
                                haptics::ProxyKind kind) const;
    void change_proxies(haptics::ProxyKind kind) noexcept;
    bool turns_with_handle(haptics::ProxyKind kind) const noexcept;
    /// Puts bodies where they are ordered to be, and gives them their properties.
    void order_bodies() noexcept;
    /// Force of the fields on a handle.
    Vec3 field_on(size_t finger) const noexcept;
    bool switch_held() const noexcept;
    /// Whether the world steps in this tick, whose Frame is not made yet.
    bool steps_now() const noexcept {
        return (frame_.sequence + 1) % settings_.dynamics.every == 0;
    }
    void make_frame(Time now, const Commands& commands, dynamics::StepStatus step) noexcept;
    void merge_contacts() noexcept;
    void merge_contacts(std::span<const contact::Contact> contacts) noexcept;
    void measure_grasp() noexcept;

    Settings settings_;
    Time period_;
    dynamics::World world_;
    std::vector<haptics::Finger> fingers_;
    std::vector<std::optional<haptics::Finger>> spares_;  // of the other kind, where it may change
    std::vector<size_t> turning_;  // fingers whose devices measure orientation
    std::unique_ptr<devices::DeviceGroup> devices_;
    std::vector<Pose> X_0D_;  // in the world without a turn, as all that is judged there
    std::vector<Pose> X_D0_;
    WorkspaceTurn turn_;
    std::vector<haptics::Handle> unturned_;
    struct Move {
        Vec3 way = Vec3::Zero();   // [m]
        Vec3 turn = Vec3::Zero();  // [rad]
    };
    std::vector<Move> moves_;  // of the unturned handles since the last tick
    Lateness late_;
    double elapsed_ = 0;             // since the last tick [s]
    haptics::Fault lateness_fault_;  // of this tick; only told where no device is real
    bool real_ = false;
    double damping_ = 0;
    haptics::CouplingSettings in_force_;
    std::vector<devices::Reading> readings_;
    std::vector<haptics::Handle> handles_;
    std::vector<haptics::HandleGuard> guards_;
    std::vector<haptics::FaultKind> device_faults_;  // of this tick's readings
    haptics::FaultLatch faults_;
    std::vector<haptics::ForceGuard> force_guards_;
    haptics::SoftStart soft_start_;
    int dead_man_ = -1;  // device with the switch; -1: none
    struct Force {
        Wrench asked_W;  // by the coupling
        Wrench felt_W;   // with what the guard adds
        Wrench felt_0;   // the same without the workspaces' turn, with the wall
        Wrench sent_0;
        Wrench sent_W;
        Wrench last_0;       // what was sent in the tick before
        unsigned flags = 0;  // haptics::LimitFlags, EnergyFlags and GuardFlags
    };
    std::vector<Force> forces_;
    std::vector<Wrench> sent_D_;
    Frame frame_;
    Commands commands_;
    double lateness_ = kUnmeasured;
    double last_tick_ = kUnmeasured;
    bool overrun_ = false;
    bool resumed_ = false;  // the next tick is the first after resume()
    bool anew_ = false;     // in the next tick all proxies begin at their handles
    bool active_ = false;
    bool stopped_ = false;
    std::atomic<bool> stopped_from_outside_{false};  // by the watchdog, since they began
    bool resting_ = false;
};

}  // namespace dihaptic::servo
