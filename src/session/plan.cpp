#include "session/plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <climits>
#include <filesystem>

#include "base/checksum.h"
#include "base/field_writer.h"
#include "base/installed.h"
#include "base/named_file.h"
#include "base/number.h"
#include "base/regular_file.h"
#include "base/text_file.h"
#include "person/pair.h"
#include "person/person.h"
#include "person/simulated_limits.h"
#include "recording/seal.h"
#include "rig/libraries.h"
#include "rows/trial_row.h"
#include "session/plan_checks.h"
#include "session/safety_limits.h"
#include "session/seated_people.h"
#include "sound/player.h"
#include "task/run/opening.h"
#include "task/run/task_director.h"
#include "task/run/task_hand.h"

namespace dihaptic::session {
namespace {

namespace fs = std::filesystem;

std::string folder_of(const std::string& file) {
    return fs::path(file).parent_path().string();
}

/// Converts "coupling.stiffness_N_m=600" to the mapping that a settings file would contain.
Node setting(const std::string& text) {
    const size_t equals = text.find('=');
    if (equals == std::string::npos) {
        throw Error({"--set", 0}, text, "has no value", "Write --set coupling.stiffness_N_m=600.");
    }
    std::string path = text.substr(0, equals);
    Node value;
    try {
        value = parse_yaml(text.substr(equals + 1), "command line");
    } catch (const Error&) {
        throw Error({"--set", 0}, text, "its value cannot be read",
                    "Write --set coupling.stiffness_N_m=600.");
    }
    for (size_t dot = path.rfind('.');; dot = path.rfind('.')) {
        value.place = {"command line", 0};
        Node outer = Node::mapping();
        outer.place = value.place;
        outer.set(dot == std::string::npos ? path : path.substr(dot + 1), value);
        value = std::move(outer);
        if (dot == std::string::npos) return value;
        path.resize(dot);
    }
}

void overlay(Plan& plan, const Node& settings, Diagnostics& diagnostics) {
    read_given_fields(plan.settings, settings, diagnostics, &plan.origins);
}

/// Reads the experiment file; for a scene file, returns an empty experiment. Throws Error.
task::Experiment experiment_of(const std::string& file, Diagnostics& diagnostics) {
    const task::FileKind kind = task::kind_of(file);
    if (kind == task::FileKind::scene) return {};
    if (kind != task::FileKind::experiment) {
        throw Error({file, 0}, "", "is neither a scene nor an experiment",
                    "A scene has 'bodies:', an experiment has 'scene:'.");
    }
    task::Experiment experiment = task::read_experiment(file, diagnostics);
    diagnostics.throw_if_errors();
    return experiment;
}

void plan_scene(Plan& plan, const Request& request, const task::Experiment& experiment,
                Diagnostics& diagnostics) {
    const std::string file =
        experiment.scene.empty() ? plan.file : named_in(folder_of(plan.file), experiment.scene);
    if (!experiment.scene.empty()) check_named(file, experiment.place, "scene");
    plan.scene_folder = folder_of(file);
    plan.scene = scene::read_scene(file, diagnostics, request.stop);
    diagnostics.throw_if_errors();
    plan.title = experiment.title.empty() ? plan.scene.title : experiment.title;
    plan.study = experiment.study;
}

/// Returns the path of the rig file; "" stands for ideal simulated devices.
std::string rig_file(const Request& request, const task::Experiment& experiment) {
    if (!request.rig.empty()) return request.rig;
    return experiment.rig.empty() ? "" : named_in(folder_of(request.file), experiment.rig);
}

void plan_rig(Plan& plan, const Request& request, const task::Experiment& experiment,
              Diagnostics& diagnostics) {
    if (const std::string file = rig_file(request, experiment); !file.empty()) {
        const bool typed = !request.rig.empty();
        if (!typed) check_named(file, experiment.place, "rig");
        plan.rig = rig::read_rig(file, diagnostics,
                                 typed ? rig::NamedBy::the_operator : rig::NamedBy::a_file);
    } else {
        // a mouse can also turn the hand, which has an effect only if orientation is measured
        plan.rig = rig::simulated_rig(scene::finger_names(plan.scene), request.mouse);
    }
    rig::check_age(plan.rig, recording::iso_now(), diagnostics);
    const auto other = [](const rig::Device& device) { return device.backend != "simulated"; };
    if (request.simulate && std::any_of(plan.rig.devices.begin(), plan.rig.devices.end(), other)) {
        diagnostics.warning(
            plan.rig.place, "devices", "are not simulated: ideal devices replace them",
            "Rehearse on similar simulated devices: use --rig, or another file under 'rig'.");
        plan.rig = rig::simulated_rig(scene::finger_names(plan.scene));
    }
    if (plan.rig.named_by == rig::NamedBy::the_operator) return;
    for (const Problem& one : rig::strange_libraries(plan.rig))
        diagnostics.warning(one.place, one.key, one.what, one.remedy);
}

/// Applies the settings of the scene, rig, experiment and command line, in this order; later values
/// override earlier ones.
void plan_settings(Plan& plan, const Request& request, const task::Experiment& experiment,
                   Diagnostics& diagnostics) {
    overlay(plan, plan.scene.settings, diagnostics);
    overlay(plan, plan.rig.settings, diagnostics);
    overlay(plan, experiment.settings, diagnostics);
    std::vector<Node> typed;
    for (const std::string& text : request.set) typed.push_back(setting(text));
    for (const Node& one : typed) overlay(plan, one, diagnostics);
    SafetySources safety{plan.rig.settings, {&plan.scene.settings, &experiment.settings}};
    for (const Node& one : typed) safety.others.push_back(&one);
    limit_safety(plan, safety, diagnostics);
}

/// Returns the path of the movement file; "" if there is none.
std::string movement_file(const Request& request, const task::Experiment& experiment) {
    if (!request.movement.empty()) return request.movement;
    if (!experiment.movement || experiment.movement->file.empty()) return "";
    const std::string file = named_in(folder_of(request.file), experiment.movement->file);
    check_named(file, experiment.movement->file_place, "file");
    return file;
}

void check_use_of_movement(const Plan& plan, const Request& request,
                           const task::Experiment& experiment, Diagnostics& diagnostics) {
    if (!experiment.movement) {
        if (request.movement.empty()) return;
        throw Error({request.file, 0}, "movement", "this file does not say how a movement is used",
                    "Use an experiment with 'movement:', such as experiments/reach-to-grasp.yaml.");
    }
    const Place& place = experiment.movement->place;
    if (rig::is_real(plan.rig)) {
        diagnostics.error(
            place, "movement", "moves simulated fingers, but this rig's devices are real",
            "Choose another rig, such as rigs/premium-pair.yaml, with --rig or under Rig in "
            "the window.");
    }
    if (experiment.task) {
        diagnostics.error(place, "movement",
                          "a task's hand follows its states, not a recorded movement",
                          "Leave out 'movement' or 'task'.");
    }
}

/// Finds the files that a task refers to; relative paths start from `folder`.
void find_files(task::Task& task, const std::string& folder, Diagnostics& diagnostics) {
    task::find_pictures(task, folder, diagnostics);
    task::find_sounds(task, folder, diagnostics);
}

/// Plans the trials and the hand that performs them.
void plan_trials(Plan& plan, task::Task task, const Request& request, Diagnostics& diagnostics) {
    find_files(task, folder_of(request.file), diagnostics);
    sound::check(task.sounds, plan.rig.sound.value_or(display::SoundOutput{}), diagnostics);
    auto made = std::make_shared<task::TaskPlan>(task::plan_task(task, plan.scene, diagnostics));
    const int number = request.order_number.value_or(task::participant_number(request.participant));
    if (task::needs_number(task) && number < 0) {
        diagnostics.error(
            task.place, "participant",
            request.participant.empty()
                ? "the order of the trials, or a draw, depends on the participant's number"
                : fmt::format("'{}' does not end in a number, and the order of the trials, or a "
                              "draw, depends on it",
                              request.participant),
            "Add e.g. --participant S07.");
    }
    diagnostics.throw_if_errors();
    made->trials = task::make_trials(made->task, number, request.seed);
    task::resolve_all(*made, diagnostics);
    plan.task = made;
}

/// Returns the driver for a person at real devices: a single phase, as long as the longest session.
std::shared_ptr<const hand::Driver> person_at_devices(const Plan& plan) {
    hand::HandSpec hand;
    hand.centre = plan.hand.centre;
    hand.script = {{"person", hand::kLongestScript, {}, Vec3::Zero(), false}};
    return std::make_shared<hand::ScriptDriver>(hand, scene::finger_names(plan.scene));
}

/// Sets the driver. If the mover is a simulated person, the driver is at first the hand described
/// in the file, which the caller replaces.
void seat_mover(Plan& plan, recording::Mover mover) {
    const std::vector<std::string> fingers = scene::finger_names(plan.scene);
    if (mover == recording::Mover::devices) {
        plan.driver = person_at_devices(plan);
    } else if (mover == recording::Mover::mouse) {
        plan.mouse = std::make_shared<hand::MouseDriver>(plan.hand, fingers);
        plan.driver = plan.mouse;
    } else {
        plan.seeing = std::make_shared<task::TaskHand>(plan.task, plan.hand, fingers);
        plan.driver = plan.seeing;
    }
    plan.moved_by.mover = mover;
}

/// Determines who or what moves the hand from the rig, the request and the files.
void plan_driver(Plan& plan, const Request& request, const task::Experiment& experiment,
                 Diagnostics& diagnostics) {
    const std::string movement = movement_file(request, experiment);
    if (rig::is_real(plan.rig)) {
        seat_mover(plan, recording::Mover::devices);
    } else if (request.mouse) {
        seat_mover(plan, recording::Mover::mouse);
    } else if (plan.task) {
        seat_mover(plan, recording::Mover::script);
    } else if (!movement.empty()) {
        plan.moved_by.mover = recording::Mover::recorded_movement;
        plan.driver = place_movement(*experiment.movement, movement, experiment.movement->place,
                                     plan.scene, plan.movement, diagnostics);
        diagnostics.throw_if_errors();
    } else {
        plan.driver =
            std::make_shared<hand::ScriptDriver>(plan.hand, scene::finger_names(plan.scene));
        plan.moved_by.mover = recording::Mover::script;
    }
}

devices::Context context_of(const Plan& plan) {
    devices::Context context;
    context.tick = plan.settings.tick();
    context.driver = plan.driver.get();
    context.impedance = plan.hand.impedance;
    context.tremor = plan.hand.tremor;
    context.seed = plan.seed;
    return context;
}

/// Checks the plan against the devices as described in the rig, without opening them.
void check_by_description(Plan& plan, Diagnostics& diagnostics) {
    plan.devices = rig::describe(plan.rig, scene::finger_names(plan.scene), context_of(plan));
    check_plan(plan, diagnostics);
    plan.warnings = diagnostics.problems();
}

}  // namespace

bool on_real_devices(const Request& request) {
    if (request.simulate) return false;
    Diagnostics ignored;
    try {
        task::Experiment experiment;
        if (task::kind_of(request.file) == task::FileKind::experiment)
            experiment = task::read_experiment(request.file, ignored);
        const std::string file = rig_file(request, experiment);
        return !file.empty() && rig::is_real(rig::read_rig(file, ignored));
    } catch (const Error&) {
        return false;
    }
}

Plan make_plan(const Request& request) {
    Plan plan;
    plan.file = request.file;
    plan.seed = request.seed;
    Diagnostics diagnostics;
    const task::Experiment experiment = experiment_of(request.file, diagnostics);
    plan_scene(plan, request, experiment, diagnostics);
    plan_rig(plan, request, experiment, diagnostics);
    plan_settings(plan, request, experiment, diagnostics);
    read_given_fields(plan.hand, plan.scene.hand, diagnostics);
    if (experiment.hand) plan.hand = *experiment.hand;
    diagnostics.throw_if_errors();
    check_use_of_movement(plan, request, experiment, diagnostics);
    if (experiment.task) plan_trials(plan, *experiment.task, request, diagnostics);
    check_columns(plan, diagnostics);
    diagnostics.throw_if_errors();
    plan_driver(plan, request, experiment, diagnostics);
    check_by_description(plan, diagnostics);
    return plan;
}

bool is_for_two(const Plan& plan) {
    return plan.task && plan.task->first_fingers.size() == 2;
}

std::string partner_of(const std::string& id) {
    return id + "-partner";
}

std::shared_ptr<person::Person> sit_down(Plan& plan, const person::Traits& traits,
                                         const std::optional<person::Traits>& partner) {
    for (const Problem& limit : person::simulated_limits(*plan.task))
        plan.warnings.push_back(limit);
    SeatedPeople seated{traits, {}};
    const auto seat = [&](const person::Traits& of, size_t participant) {
        return std::make_shared<person::Person>(
            of, person::Situation{plan.task, plan.scene, plan.hand, plan.settings.tick(), plan.seed,
                                  participant});
    };
    auto person = seat(traits, 0);
    plan.seeing = person;
    if (is_for_two(plan)) {
        seated.partner = partner.value_or(traits);
        if (!partner) seated.partner->id = partner_of(traits.id);
        plan.partner = seat(*seated.partner, 1);
        plan.seeing =
            std::make_shared<person::Pair>(person, plan.partner, plan.task->first_fingers[1]);
    }
    plan.person = to_yaml(write_fields(seated));
    plan.driver = plan.seeing;
    plan.moved_by = {
        recording::Mover::simulated_person, recording::program_version(),
        traits.group.empty() ? traits.population : traits.population + ", group " + traits.group,
        number_text(plan.seed)};
    return person;
}

namespace {

/// Reads the attempts from trials.csv, which has one row per attempt in chronological order, and
/// computes the file's checksum.
std::vector<task::Attempt> attempts_made(const task::TaskPlan& plan, const std::string& file,
                                         std::string& checksum) {
    const auto bad = [&](const char* what) {
        return Error({file, 0}, "", what,
                     "Rebuild it from raw.log: dihaptic recover, on the session's folder.");
    };
    const std::string text = read_bytes(file, kMostTable);
    checksum = checksum_of(text);
    if (text.empty()) throw bad("is empty");
    if (!text.ends_with('\n')) throw bad("is cut off in its last line");
    const rows::TrialFile trials(file);
    if (!trials.column("outcome")) throw bad("has no column 'outcome'");
    std::vector<task::Attempt> out;
    for (size_t i = 0; i < trials.size(); ++i) {
        const int trial = trials[i].asked.trial, attempt = trials[i].measures.attempt;
        if (trial < 1 || static_cast<size_t>(trial) > plan.trials.size() || attempt < 1)
            throw bad("has a row without a trial of the session, or without its attempt");
        const std::string& outcome = trials[i].measures.outcome;
        const auto same = [&](const task::TaskPlan::Outcome& o) { return o.name == outcome; };
        const auto found = std::find_if(plan.outcomes.begin(), plan.outcomes.end(), same);
        out.push_back(
            {trial - 1, attempt,
             found == plan.outcomes.end() ? -1 : static_cast<int>(found - plan.outcomes.begin())});
        for (const task::Variable& variable : plan.task.variables) {
            const double value = trials.number(i, trials.column(task::next_column(variable.name)));
            if (!std::isfinite(value)) throw bad("has a row without the value of a variable");
            out.back().variables.push_back(value * split_unit(variable.name).si);
        }
    }
    return out;
}

/// Returns the mover of a session's hand; throws Error if that mover cannot move the hand again.
/// Earlier versions did not record the mover, but only a person holds real devices, and only a
/// session of a simulated person contains person.yaml.
recording::Mover mover_of(const recording::SessionInfo& info, const Plan& plan,
                          const recording::SessionFolder& folder, Seat seat) {
    using recording::Mover;
    Mover mover = info.moved_by.mover;
    if (mover == Mover::not_recorded && rig::is_real(plan.rig)) mover = Mover::devices;
    if (mover == Mover::not_recorded && is_there(folder.file("person.yaml")))
        mover = Mover::simulated_person;
    const std::string file = folder.file("session.yaml");
    if (mover == Mover::not_recorded) {
        throw Error({file, 0}, "moved_by",
                    "does not state whether a mouse or the file's script moved the hand, and "
                    "trials of the two must not be mixed",
                    "If you know it, add it to that file, as 'moved_by: { mover: mouse }' or "
                    "'moved_by: { mover: script }'. Otherwise run the experiment again.");
    }
    if (mover == Mover::mouse && seat == Seat::terminal) {
        throw Error({file, 0}, "moved_by",
                    "states that a person moved the hand by mouse, which is not available here: a "
                    "script's trials would be recorded under this participant's name",
                    "Continue in the window: dihaptic gui.");
    }
    if ((mover == Mover::devices) != rig::is_real(plan.rig)) {
        throw Error({file, 0}, "moved_by",
                    fmt::format("states {}, but the rig's devices are {}", enum_name(mover),
                                rig::is_real(plan.rig) ? "real" : "simulated"),
                    "Restore the session.yaml, or the rig.yaml, of this session.");
    }
    return mover;
}

/// Returns the path of a folder including its name (which a path such as "." lacks), by which
/// readers can identify the session.
std::string named(const std::string& folder) {
    const fs::path name = fs::path(folder).filename();
    return name == "." || name == ".." ? fs::canonical(folder).string() : folder;
}

/// Makes the plan of a session from the session's own files, with the outcome of each attempt.
Plan frozen_plan(const recording::SessionFolder& folder, const recording::SessionInfo& info,
                 Diagnostics& diagnostics) {
    if (!is_there(folder.file("task.yaml"))) {
        throw Error(
            {folder.path(), 0}, "", "has no trials that could be resumed",
            "Run the experiment again; dihaptic recover makes the files of the existing part.");
    }
    diagnostics.add(folder.changed(info.inputs, Severity::error));
    constexpr std::string_view kDone[] = {"trials.csv"};
    diagnostics.add(recording::broken_seals(folder, info, Severity::error, kDone));
    diagnostics.throw_if_errors();
    Plan plan;
    plan.file = info.experiment;
    plan.title = info.title;
    plan.study = info.study;
    plan.seed = folder.seed_of(info);
    plan.resumes = named(folder.path());
    plan.scene_folder = folder.path();
    plan.scene = scene::read_scene(folder.file("scene.yaml"), diagnostics);
    plan.rig = rig::read_rig(folder.file("rig.yaml"), diagnostics);
    overlay(plan, read_yaml(folder.file("settings.yaml")), diagnostics);
    read_given_fields(plan.hand, plan.scene.hand, diagnostics);
    task::Task task;
    read_fields(task, read_yaml(folder.file("task.yaml")), diagnostics);
    find_files(task, folder.path(), diagnostics);
    diagnostics.throw_if_errors();
    auto made = std::make_shared<task::TaskPlan>(task::plan_task(task, plan.scene, diagnostics));
    diagnostics.throw_if_errors();
    made->trials = task::read_trial_list(made->task, folder.file("trial-list.csv"));
    task::resolve_all(*made, diagnostics);
    plan.task = made;
    plan.done = attempts_made(*made, folder.file("trials.csv"), plan.done_checksum);
    return plan;
}

bool any_left(const Plan& plan) {
    return task::TaskDirector(*plan.task, plan.seed, plan.settings.tick(), plan.done).share() < 1;
}

}  // namespace

bool trials_left(const std::string& session) {
    const auto folder = recording::SessionFolder::open_tables(session);
    Diagnostics diagnostics;
    return any_left(frozen_plan(folder, folder.read_info(), diagnostics));
}

Plan make_rest(const std::string& session, Seat seat, recording::SessionInfo& info) {
    const auto folder = recording::SessionFolder::open(session);
    info = folder.read_info();
    Diagnostics diagnostics;
    Plan plan = frozen_plan(folder, info, diagnostics);
    if (!any_left(plan)) {
        throw Error({session, 0}, "", "is complete: all its trials are done",
                    "Run the experiment again for another session.");
    }
    rig::check_libraries(plan.rig);
    seat_mover(plan, mover_of(info, plan, folder, seat));
    check_by_description(plan, diagnostics);
    return plan;
}

void apply_setting(frame::Settings& settings, const std::string& text) {
    Diagnostics diagnostics;
    read_fields(settings, setting(text), diagnostics);
    if (settings.coupling.stiffness_share || settings.coupling.damping_share) {
        diagnostics.error({"--set", 0}, text, "is a share of a device's maximum",
                          "No device here reports its maximum: write coupling.stiffness_N_m or "
                          "coupling.damping_Ns_m.");
    }
    diagnostics.throw_if_errors();
}

std::unique_ptr<devices::DeviceGroup> open_devices(Plan& plan, const std::string& host,
                                                   const std::function<bool()>& given_up) {
    std::optional<host::Hosting> hosting;
    if (!host.empty()) {
        // one tick more than the servo allows, as for the servo's own watchdog
        const double silence = plan.settings.safety.max_pause + plan.settings.tick();
        hosting = {host, silence, plan.settings.real_time_priority, given_up};
    }
    auto out =
        rig::make_devices(plan.rig, scene::finger_names(plan.scene), context_of(plan), hosting);
    if (out->descriptions() == plan.devices) return out;
    plan.devices = out->descriptions();
    Diagnostics diagnostics;
    check_devices(plan, diagnostics);
    for (const Problem& problem : diagnostics.problems()) {
        const auto same = [&](const Problem& old) { return old.text() == problem.text(); };
        if (std::none_of(plan.warnings.begin(), plan.warnings.end(), same))
            plan.warnings.push_back(problem);
    }
    return out;
}

std::unique_ptr<servo::Servo> make_servo(const Plan& plan,
                                         std::unique_ptr<devices::DeviceGroup> devices) {
    const std::vector<std::string> fingers = scene::finger_names(plan.scene);
    if (devices == nullptr) devices = rig::make_devices(plan.rig, fingers, context_of(plan));
    return std::make_unique<servo::Servo>(plan.scene, plan.settings, std::move(devices),
                                          rig::poses(plan.rig, fingers), rig::wall_box(plan.rig));
}

}  // namespace dihaptic::session
