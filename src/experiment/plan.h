// A plan is everything that a session needs, read, resolved and checked: nothing is left to go
// wrong for lack of a file once a person holds the devices.
#pragma once

#include <memory>
#include <vector>

#include "experiment/movement.h"
#include "experiment/seeing_driver.h"
#include "experiment/task_plan.h"
#include "hand/mouse.h"
#include "hand/script.h"
#include "recording/session.h"
#include "rig/rig.h"
#include "scene/scene.h"
#include "servo/servo.h"

namespace dihaptic::experiment {

/// What the user asked for.
struct Request {
    std::string file;              ///< a scene or an experiment
    std::string rig;               ///< in place of the experiment's
    std::string movement;          ///< in place of the experiment's
    std::vector<std::string> set;  ///< "coupling.stiffness_N_m=600": settings from the command line
    uint64_t seed = 1;
    bool mouse = false;       ///< somebody at a screen moves the simulated hand, not the file
    std::string participant;  ///< identifier: its number may order the trials
    std::optional<int> order_number;  ///< orders the trials in its place
    bool simulate = false;            ///< simulated devices, whatever the rig has
};

struct Plan {
    std::string title;
    std::string file;
    std::string scene_folder;  ///< that the scene's meshes are relative to
    scene::Scene scene;
    rig::Rig rig;
    servo::Settings settings;
    Origins origins;
    hand::HandSpec hand;
    /// Shared with the devices that it moves; the fingers of a person at real ones stay where it
    /// is.
    std::shared_ptr<const hand::Driver> driver;
    std::shared_ptr<hand::MouseDriver> mouse;  ///< the driver, if it is one
    recording::MovedBy moved_by;               ///< what the driver stands for
    recording::Study study;
    std::optional<MovementReport> movement;
    std::shared_ptr<const TaskPlan> task;  ///< trials, if the experiment has some
    std::shared_ptr<SeeingDriver> seeing;  ///< the driver, if it sees
    std::string person;                    ///< the driver, if it is one: person.yaml
    std::vector<Attempt> done;             ///< what an earlier part of the session did
    std::string resumes;                   ///< that session's folder
    std::vector<Problem> warnings;
    uint64_t seed = 1;

    /// Whether it goes on until somebody ends it.
    bool open_ended() const { return !task && (mouse || rig::is_real(rig)); }
};

/// Overlays a setting in words, such as "coupling.stiffness_N_m=600". Throws Error.
void apply_setting(servo::Settings& settings, const std::string& text);

/// Whether a session of it is on real devices, which keep real time. What is wrong with its files
/// make_plan() says.
bool on_real_devices(const Request& request);

/// Reads and checks. On real devices nobody simulates a hand: what the files say of one is passed
/// over, and without trials the session goes on until somebody ends it. Throws Error with every
/// problem found.
Plan make_plan(const Request& request);

/// Where somebody wants to go on with a session: only a window has a mouse.
enum class Seat { terminal, window };

/// What is left of a session with trials, from its frozen inputs and its tables, moved by what
/// moved it before. Of a simulated person the driver is for the caller to put there
/// (session/resume.h). Throws Error when there is nothing left, when it has no trials, or when what
/// moved its hand is not known or cannot do so here.
Plan make_rest(const std::string& session, Seat seat, recording::SessionInfo& info);
/// Whether anything is left of it. Throws Error when it has no trials, or its files are damaged.
bool trials_left(const std::string& session);

/// Servo on the plan's rig. `keeper`: the program that owns its devices if they are real; "": this
/// one does.
std::unique_ptr<servo::Servo> make_servo(const Plan& plan, const std::string& keeper = "");

}  // namespace dihaptic::experiment
