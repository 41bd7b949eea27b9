// A plan contains all inputs of a session, already read, resolved and checked, so that no file can
// turn out to be missing or wrong once a person holds the devices.
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

/// What the user requests.
struct Request {
    std::string file;              ///< path of a scene or experiment file
    std::string rig;               ///< rig file to use instead of the experiment's
    std::string movement;          ///< movement file to use instead of the experiment's
    std::vector<std::string> set;  ///< settings given as "coupling.stiffness_N_m=600"
    uint64_t seed = 1;
    bool mouse = false;               ///< whether a mouse, not the file, moves the simulated hand
    std::string participant;          ///< participant ID, whose number may set the order of trials
    std::optional<int> order_number;  ///< used instead of the number in the participant ID
    bool simulate = false;            ///< use simulated devices, whatever devices the rig has
    std::stop_token stop;             ///< cancels the reading and cutting of meshes
};

struct Plan {
    std::string title;
    std::string file;
    std::string scene_folder;  ///< the paths of the scene's meshes are relative to this folder
    scene::Scene scene;
    rig::Rig rig;
    /// Descriptions of the devices, indexed by finger: from the rig or, once the devices are open,
    /// as reported by the devices.
    std::vector<frame::DeviceInfo> devices;
    frame::Settings settings;
    Origins origins;
    hand::HandSpec hand;
    /// The driver that moves all simulated devices. If a person holds real devices, the driver
    /// stands still.
    std::shared_ptr<const hand::Driver> driver;
    std::shared_ptr<hand::MouseDriver> mouse;  ///< the driver if a mouse moves the hand, else null
    recording::MovedBy moved_by;               ///< the mover that the driver represents
    Study study;
    std::optional<MovementReport> movement;
    std::shared_ptr<const task::TaskPlan> task;  ///< the trials; null if the experiment has none
    std::shared_ptr<task::SeeingDriver> seeing;  ///< the driver if it reacts to what it sees
    std::shared_ptr<person::Person> partner;     ///< simulated partner in a task for two people
    std::string person;               ///< text of person.yaml, if the driver is a simulated person
    bool resumable = true;            ///< whether the driver can be rebuilt from session files
    std::vector<task::Attempt> done;  ///< attempts already made in an earlier part of the session
    std::string resumes;              ///< folder of the earlier part; empty if there is none
    std::string done_checksum;        ///< checksum of its trials.csv, as read (base/checksum.h)
    std::vector<Problem> warnings;
    uint64_t seed = 1;

    /// Whether the session continues until the operator ends it.
    bool open_ended() const { return !task && (mouse || rig::is_real(rig)); }
};

/// Applies a setting given as text, such as "coupling.stiffness_N_m=600". Throws Error if the
/// setting is invalid.
void apply_setting(frame::Settings& settings, const std::string& text);

/// Whether the requested session runs on real devices, and therefore in real time. Problems with
/// the session's files are reported by make_plan().
bool on_real_devices(const Request& request);

/// Reads and checks all files, without opening devices. On real devices no hand is simulated: a
/// hand described in the files is ignored, and if there are no trials, the session continues until
/// the operator ends it. Throws an Error that contains every problem found.
Plan make_plan(const Request& request);

/// Whether the plan's task requires two participants.
bool is_for_two(const Plan& plan);
/// Returns the ID of a simulated participant's partner.
std::string partner_of(const std::string& id);

/// Replaces the plan's hand with a simulated person, and returns this person, who is owned by the
/// plan. The plan must have trials. `partner` contains the traits of the other person in a task for
/// two; if it is unset, the partner has the same traits and differs only by chance.
std::shared_ptr<person::Person> sit_down(Plan& plan, const person::Traits& traits,
                                         const std::optional<person::Traits>& partner = {});

/// Where a session is resumed: only a window can use a mouse.
enum class Seat { terminal, window };

/// Plans the rest of a session with trials, from its frozen inputs and its tables, with the same
/// mover as before. If the mover is a simulated person, the caller must add the driver
/// (session/resume.h). Throws Error when no trial is left, when the session has no trials, or when
/// the mover of its hand is unknown or cannot be used here.
Plan make_rest(const std::string& session, Seat seat, recording::SessionInfo& info);
/// Whether the session has trials left. Throws Error if the session never had any trials or if its
/// files are damaged.
bool trials_left(const std::string& session);

/// Opens the plan's devices, which are then passed to its session. If the devices report more than
/// their rig does, the plan is checked against their report: settings given as a share of the
/// devices' maximum are resolved, and warnings are added. `host` is the program that owns real
/// devices (host::program()) and switches force off when this process crashes; if it is "", this
/// process owns the devices. The plan's driver must outlive the devices. `given_up` returns whether
/// to stop waiting for a device host that does not answer; it may be empty. Throws Error.
std::unique_ptr<devices::DeviceGroup> open_devices(Plan& plan, const std::string& host = "",
                                                   const std::function<bool()>& given_up = {});

/// Makes a servo that uses the plan's open devices. If `devices` is null, opens the devices, which
/// this process then owns.
std::unique_ptr<servo::Servo> make_servo(const Plan& plan,
                                         std::unique_ptr<devices::DeviceGroup> devices = nullptr);

}  // namespace dihaptic::session
