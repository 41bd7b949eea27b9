// A plan holds all inputs of a session, read, resolved and checked, so that no file can be missing
// or wrong once a person holds the devices.
#pragma once

#include <memory>
#include <stop_token>
#include <vector>

#include "hand/mouse.h"
#include "hand/script.h"
#include "person/traits.h"
#include "recording/session.h"
#include "rig/rig.h"
#include "scene/scene.h"
#include "servo/servo.h"
#include "session/movement.h"
#include "task/plan/task_plan.h"
#include "task/run/seeing_driver.h"

namespace dihaptic::person {
class Person;
}

namespace dihaptic::session {

/// The user's request.
struct Request {
    std::string file;              ///< a scene or an experiment
    std::string rig;               ///< replaces the experiment's rig
    std::string movement;          ///< replaces the experiment's movement
    std::vector<std::string> set;  ///< "coupling.stiffness_N_m=600": settings from the command line
    uint64_t seed = 1;
    bool mouse = false;               ///< a mouse, not the file, moves the simulated hand
    std::string participant;          ///< identifier, whose number may set the order of trials
    std::optional<int> order_number;  ///< used in place of the participant's number
    bool simulate = false;            ///< simulated devices, whatever devices the rig has
    std::stop_token stop;             ///< ends the reading and cutting of meshes
};

struct Plan {
    std::string title;
    std::string file;
    std::string scene_folder;  ///< folder to which the paths of the scene's meshes are relative
    scene::Scene scene;
    rig::Rig rig;
    /// Description of the devices by the rig or, once they are open, by themselves; by finger.
    std::vector<frame::DeviceInfo> devices;
    frame::Settings settings;
    Origins origins;
    hand::HandSpec hand;
    /// Moves simulated devices, which share it. With a person at real devices, the driver stays
    /// still.
    std::shared_ptr<const hand::Driver> driver;
    std::shared_ptr<hand::MouseDriver> mouse;  ///< the driver, if a mouse moves the hand
    recording::MovedBy moved_by;               ///< the mover that the driver represents
    Study study;
    std::optional<MovementReport> movement;
    std::shared_ptr<const task::TaskPlan> task;  ///< trials; null if the experiment has none
    std::shared_ptr<task::SeeingDriver> seeing;  ///< the driver, if it acts on its sight
    std::shared_ptr<person::Person> partner;     ///< simulated partner in a task for two
    std::string person;               ///< text of person.yaml, if the driver is a simulated person
    bool resumable = true;            ///< the driver can be rebuilt from the session's files
    std::vector<task::Attempt> done;  ///< attempts made in an earlier part of the session
    std::string resumes;              ///< folder of that earlier part; empty if there is none
    std::string done_checksum;        ///< checksum of its trials.csv, as read (base/checksum.h)
    std::vector<Problem> warnings;
    uint64_t seed = 1;

    /// Whether the session continues until the operator ends it.
    bool open_ended() const { return !task && (mouse || rig::is_real(rig)); }
};

/// Applies a setting given as text, such as "coupling.stiffness_N_m=600". Throws Error.
void apply_setting(frame::Settings& settings, const std::string& text);

/// Whether the requested session runs on real devices, which keep real time. Problems with its
/// files are reported by make_plan().
bool on_real_devices(const Request& request);

/// Reads and checks all files; opens no device. On real devices no hand is simulated: a hand in the
/// files is ignored, and without trials the session continues until the operator ends it. Throws
/// Error with every problem found.
Plan make_plan(const Request& request);

/// Whether the plan's task is for two participants.
bool is_for_two(const Plan& plan);
/// Identifier of a simulated participant's partner.
std::string partner_of(const std::string& id);

/// Puts a simulated person in place of the plan's hand, and returns the person, who belongs to the
/// plan. The plan must have trials. `partner`: the other person in a task for two; if unset,
/// somebody with the same traits, who differs only by chance.
std::shared_ptr<person::Person> sit_down(Plan& plan, const person::Traits& traits,
                                         const std::optional<person::Traits>& partner = {});

/// The program that resumes a session: only a window has a mouse.
enum class Seat { terminal, window };

/// Plans the rest of a session with trials, from its frozen inputs and its tables, with the same
/// mover as before. The caller adds the driver of a simulated person (session/resume.h). Throws
/// Error when no trial is left, when the session has no trials, or when the mover of its hand is
/// unknown or not available here.
Plan make_rest(const std::string& session, Seat seat, recording::SessionInfo& info);
/// Whether the session has trials left. Throws Error if it never had any or if its files are
/// damaged.
bool trials_left(const std::string& session);

/// Opens the plan's devices, which its session takes over. If they report more than their rig does,
/// the plan is checked against their report: settings given as shares of their maximum are
/// resolved, and warnings added. `host`: the program that owns real devices (host::program())
/// and switches the force off when this process dies; "": this process owns them. The plan's driver
/// must outlive the devices. `given_up`: returns whether to stop waiting for a device host that
/// does not answer; may be empty. Throws Error.
std::unique_ptr<devices::DeviceGroup> open_devices(Plan& plan, const std::string& host = "",
                                                   const std::function<bool()>& given_up = {});

/// Makes a servo on the plan's open devices; null: opens them, owned by this process.
std::unique_ptr<servo::Servo> make_servo(const Plan& plan,
                                         std::unique_ptr<devices::DeviceGroup> devices = nullptr);

}  // namespace dihaptic::session
