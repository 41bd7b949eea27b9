// The Servo does one tick at a time, as an ordinary function with time as an argument. Real time,
// tests, batch runs and replay all call the same function:
//
//   read the devices -> director -> fold the couplings -> step the world -> forces -> limits ->
//   write -> Frame
//
// The written force belongs to the positions read in the same tick.
#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <utility>

#include "frame/orders.h"
#include "frame/settings.h"
#include "haptics/finger.h"
#include "haptics/force_guard.h"
#include "haptics/safety.h"
#include "haptics/soft_start.h"
#include "rig/rig.h"
#include "servo/lateness.h"
#include "servo/workspace_turn.h"

namespace dihaptic::servo {

/// Time for which a run continues after a fault, with the force off, to record the motion of the
/// objects.
constexpr Time kGrace = std::chrono::seconds(1);

class Servo {
  public:
    /// `X_WD` and the devices are in the order of the scene's fingers. `wall` is the box in which
    /// hands are kept; without a wall, the box is each device's workspace, if stated.
    Servo(const scene::Scene& scene, const frame::Settings& settings,
          std::unique_ptr<devices::DeviceGroup> devices, std::vector<Pose> X_WD,
          const std::optional<Eigen::AlignedBox3d>& wall = {});
    ~Servo();

    /// Reserves all memory and switches the devices on.
    void activate();
    /// Sends zero force and switches the devices off.
    void deactivate();
    /// Sends zero force between two ticks, for a pause. Time continues without a gap, and force
    /// returns gently.
    void rest() noexcept;
    /// To be called after rest(), before the next tick: hands may have moved in the meantime. Force
    /// returns gently, from zero in the next tick. After a fault the devices are activated again
    /// and the fault is cleared; in a world that diverged, lost bodies are returned to their poses
    /// in the scene. Throws Error when the devices cannot be activated.
    void resume();
    /// Reserves memory in `frame` for any Frame of this servo, so that copying one into it
    /// allocates nothing.
    void reserve(frame::Frame& frame) const;

    /// One tick at `now`; returns its Frame, valid until the next tick.
    const frame::Frame& tick(Time now, const frame::Director& director) noexcept;
    /// Whether the last tick was the final one: its director requested a stop or a rest, a
    /// recording ended, the operator switched force off, or the grace after a fault is over.
    bool stopped() const { return stopped_; }
    /// Whether the last tick's director requested only a rest.
    bool resting() const { return resting_; }
    /// The reason why force is off, if it is.
    const haptics::Fault& fault() const { return faults_.fault(); }
    /// Makes the devices call `tick` as described for devices::DeviceGroup::pace().
    void pace(const std::function<bool()>& tick) { devices_->pace(tick); }
    /// Switches force off on all devices at once; false if they do not support this. May be called
    /// from any thread.
    bool stop_devices() noexcept;
    /// Energy that a finger's coupling generated, as counted by haptics::EnergyGuard [J].
    double generated(int finger) const {
        return force_guards_[static_cast<size_t>(finger)].generated();
    }
    /// Called by loops that keep real time: the values go into the next Frame, and `max_late` is
    /// compared with the lateness.
    void note_timing(double lateness, double last_tick, bool overrun) noexcept;
    /// Whether a person's hand holds devices, so that a late tick may be a fault. Otherwise
    /// lateness is only reported.
    bool real() const { return real_; }
    /// Damping of handle and hand, which determines the stiffness allowed for a late loop: the
    /// smallest value stated by any device, unless set by safety.hand_damping [N*s/m].
    double damping() const { return damping_; }

    Time period() const { return period_; }
    const frame::Settings& settings() const { return settings_; }
    const dynamics::World& world() const { return world_; }
    dynamics::World& world() { return world_; }
    const devices::DeviceGroup& devices() const { return *devices_; }
    /// For reading between ticks, while the devices are active.
    devices::DeviceGroup& devices() { return *devices_; }

  private:
    void measure(Time now) noexcept;
    void judge_lateness(Time now, double elapsed) noexcept;
    /// Sets the couplings as requested, but no stiffer than the loop allows.
    void retune() noexcept;
    void bound_rise(size_t finger, double share) noexcept;
    /// Sets bodies as ordered, pulls proxies to their handles, and steps the world if a step is
    /// due.
    dynamics::StepStatus advance_world() noexcept;
    /// Applies the knobs, each as far as possible in this tick.
    void turn_knobs() noexcept;
    void turn_workspaces(double rate) noexcept;
    void make_forces(Time now) noexcept;
    haptics::Finger make_finger(const scene::Scene& scene, size_t finger, dynamics::BodyIndex proxy,
                                scene::ProxyKind kind) const;
    void change_proxies(scene::ProxyKind kind) noexcept;
    bool turns_with_handle(scene::ProxyKind kind) const noexcept;
    /// Sets the ordered poses and properties of bodies.
    void order_bodies() noexcept;
    void order_joints() noexcept;
    /// Applies the loads on bodies, and those of motors, to the coming step.
    void apply_loads() noexcept;
    /// Adds the loads on a handle to its force.
    void add_loads(size_t finger, Wrench& felt_W) const noexcept;
    bool switch_held() const noexcept;
    /// Whether the world steps in this tick; valid before the tick's Frame is filled.
    bool steps_now() const noexcept {
        return (frame_.sequence + 1) % settings_.dynamics.every == 0;
    }
    void make_frame(Time now, const frame::Commands& commands, dynamics::StepStatus step) noexcept;
    void merge_contacts() noexcept;
    void merge_contacts(std::span<const contact::Contact> contacts) noexcept;
    void measure_grasp() noexcept;

    frame::Settings settings_;
    Time period_;
    dynamics::World world_;
    std::vector<haptics::Finger> fingers_;
    std::vector<std::optional<haptics::Finger>>
        spares_;                   // fingers of the other proxy kind, if the kind can change
    std::vector<size_t> turning_;  // fingers whose devices measure orientation
    std::unique_ptr<devices::DeviceGroup> devices_;
    std::vector<Pose> X_0D_;  // poses in the world before the workspaces' turn
    std::vector<Pose> X_D0_;
    WorkspaceTurn turn_;
    std::vector<frame::Handle> unturned_;
    struct Move {
        Vec3 way = Vec3::Zero();   // [m]
        Vec3 turn = Vec3::Zero();  // [rad]
    };
    std::vector<Move> moves_;  // of the unturned handles since the last tick
    Lateness late_;
    double elapsed_ = 0;             // since the last tick [s]
    haptics::Fault lateness_fault_;  // of this tick; only reported if no device is real
    bool real_ = false;
    double damping_ = 0;
    frame::CouplingSettings in_force_;
    std::vector<devices::Reading> readings_;
    std::vector<frame::Handle> handles_;
    std::vector<haptics::HandleGuard> guards_;
    std::vector<haptics::FaultKind> device_faults_;  // of this tick's readings
    haptics::FaultLatch faults_;
    std::vector<haptics::ForceGuard> force_guards_;
    haptics::SoftStart soft_start_;
    int dead_man_ = -1;  // device with the switch; -1: none
    struct Force {
        Wrench asked_W;  // requested by the coupling
        Wrench felt_W;   // with the guard's addition
        Wrench felt_0;   // felt_W before the workspaces' turn, with the wall
        Wrench sent_0;
        Wrench sent_W;
        Wrench last_0;        // wrench sent in the last tick
        uint32_t status = 0;  // of the force alone
    };
    std::vector<Force> forces_;
    std::vector<Wrench> sent_D_;
    frame::Frame frame_;
    frame::Commands commands_;
    double lateness_ = kUnmeasured;
    double last_tick_ = kUnmeasured;
    bool overrun_ = false;
    bool resumed_ = false;  // whether the next tick is the first after resume()
    bool anew_ = false;     // whether all proxies are placed at their handles in the next tick
    bool active_ = false;
    bool stopped_ = false;
    std::atomic<bool> stopped_from_outside_{false};  // by the watchdog, since activation
    bool resting_ = false;
};

}  // namespace dihaptic::servo
