#include "experiment/session_run.h"

#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <condition_variable>
#include <filesystem>
#include <random>
#include <thread>

#include "base/field_writer.h"
#include "base/plural.h"
#include "experiment/frozen_inputs.h"
#include "experiment/outward.h"
#include "experiment/phase_director.h"
#include "experiment/task_director.h"

namespace dihaptic::experiment {
namespace {

namespace fs = std::filesystem;
using Wall = std::chrono::steady_clock;

double since(Wall::time_point begin) {
    return std::chrono::duration<double>(Wall::now() - begin).count();
}

/// No session is longer: beyond, a task waits for something that does not come.
constexpr Time kLongest = std::chrono::hours(12);
constexpr Time kLongestTimed = std::chrono::hours(1);

std::vector<recording::PhaseInfo> phases_of(const hand::Driver& driver) {
    std::vector<recording::PhaseInfo> out;
    for (const hand::Driver::Phase& phase : driver.phases())
        out.push_back({phase.name, phase.start, phase.end});
    return out;
}

/// What the session's devices can do, by finger.
std::vector<recording::DeviceRecord> records_of(const servo::Servo& servo,
                                                const scene::Scene& scene) {
    std::vector<recording::DeviceRecord> out;
    for (int i = 0; i < servo.devices().size(); ++i) {
        const devices::DeviceInfo& device = servo.devices().info(i);
        recording::DeviceRecord& record = out.emplace_back();
        record.finger = scene.fingers[static_cast<size_t>(i)].name;
        record.model = device.model;
        record.peak_force = device.peak_force;
        record.workspace = device.workspace;
        record.orientation = device.measures_orientation;
        record.peak_torque = device.peak_torque;
        record.scale = device.scale;
        if (std::isfinite(device.continuous_force))
            record.continuous_force = device.continuous_force;
        if (std::isfinite(device.continuous_torque))
            record.continuous_torque = device.continuous_torque;
        record.simulated = device.simulated;
        if (servo.real()) record.damping = servo.damping();
    }
    return out;
}

recording::LogHead log_head(const scene::Scene& scene, const servo::Settings& settings,
                            const recording::Setup& setup) {
    recording::LogHead head;
    static_cast<recording::Setup&>(head) = setup;
    head.tick = settings.tick();
    head.fingers = scene::finger_names(scene);
    for (const scene::Body& body : scene.bodies) head.bodies.push_back(body.name);
    return head;
}

/// On the virtual clock the same session is the same file, and has the same identity: it comes from
/// what the session depends on. On the real clock no two are the same.
std::string identity_of(const recording::Setup& setup, const Plan& plan, bool real) {
    if (real) {
        std::random_device random;
        return fmt::format("{:08x}{:08x}", random(), random());
    }
    std::string text = to_yaml(write_fields(setup));
    for (const int outcome : plan.done) text += fmt::format("{} ", outcome);
    return fmt::format("{:016x}", recording::session_of(std::as_bytes(std::span(text))));
}

/// Whether a trigger comes to a simulated session in this tick: what is waited for comes once a
/// second.
bool simulated_trigger(const servo::Frame& last, Time period) noexcept {
    return (last.time + period) % std::chrono::seconds(1) < period;
}

/// A simulated hand that never does what a trial waits for would fill the disk.
struct Wait {
    static constexpr double kLongestBetween = 60;  // trials [s]
    static constexpr double kLongest = 60;         // in a state, beyond its exit by time [s]
    static constexpr double kRounds = 10;          // through all states, in one attempt

    /// `stages`: of the task.
    explicit Wait(const std::vector<TaskPlan::Stage>& stages) : bounds{kLongestBetween} {
        for (const TaskPlan::Stage& stage : stages) {
            double longest = 0;
            for (const TaskPlan::Way& way : stage.ways) {
                if (way.exit.when == When::time) longest = std::max(longest, way.exit.hold);
            }
            bounds.push_back(longest + kLongest);
            attempt_bound += kRounds * bounds.back();
        }
    }

    void look(const servo::Frame& last, const servo::Commands& commands) noexcept {
        const double now = seconds(last.time);
        if (last.trial != trial || last.task.attempt != attempt) begun = since = now;
        if (last.phase != phase) since = now;
        trial = last.trial;
        attempt = last.task.attempt;
        phase = last.phase;
        ended = now;
        const bool same = commands.trial == trial && commands.phase == phase;
        over = (same && now - since > bounds[static_cast<size_t>(phase)]) ||
               now - begun > attempt_bound;
    }
    std::string describe(const std::vector<recording::PhaseInfo>& phases) const {
        const auto i = static_cast<size_t>(phase);
        return fmt::format(
            "The simulated hand never ended '{}' of trial {}: the session ends after {:.0f} s of "
            "it. "
            "{}",
            i < phases.size() ? phases[i].name : "a state", trial, ended - since,
            phase == kBetween ? "Its fingers stay where an object is put back: let the last state "
                                "lead them away."
                              : "Give the state an exit by time, or the hand steps that meet one; "
                                "states that lead back to each other need a way out.");
    }

    int trial = 0;
    int attempt = 0;
    int phase = 0;
    double since = 0;            // of the state [s]
    double begun = 0;            // of the attempt [s]
    double ended = 0;            // what was seen last [s]
    std::vector<double> bounds;  // by phase [s]
    double attempt_bound = kLongestBetween;
    bool over = false;
};

/// Calls `look` about ten times a second from a thread of its own while something runs, and once
/// after.
class Watcher {
  public:
    explicit Watcher(const std::function<void()>& look) {
        thread_ = std::thread([this, look] {
            std::unique_lock lock(mutex_);
            while (!done_) {
                condition_.wait_for(lock, std::chrono::milliseconds(100));
                look();
            }
        });
    }
    ~Watcher() {
        {
            const std::lock_guard lock(mutex_);
            done_ = true;
        }
        condition_.notify_all();
        if (thread_.joinable()) thread_.join();
    }

  private:
    std::mutex mutex_;
    std::condition_variable condition_;
    bool done_ = false;
    std::thread thread_;
};

/// Waits in a pause, and wakes the servo after it: when its devices cannot be, says why and waits
/// again. False: the session ends.
bool wait_to_go_on(servo::Servo& servo, Live& live, const std::atomic<bool>& stop) {
    while (true) {
        while (live.paused && !stop && !live.ended)
            std::this_thread::sleep_for(std::chrono::milliseconds(10));
        if (stop || live.ended) return false;
        try {
            servo.resume();
            return true;
        } catch (const Error& e) {
            live.tell(e.what());
        }
    }
}

}  // namespace

RunResult run_session(const Plan& plan, const RunOptions& options, const std::atomic<bool>& stop,
                      const Progress& progress) {
    const bool real = options.clock == Clock::real;
    if (!real && rig::is_real(plan.rig)) {
        throw Error(plan.rig.place, "devices", "are real, and keep real time",
                    "Run them on the real clock, or choose a rig of simulated devices.");
    }
    const std::string name = fs::path(plan.file).stem().string();
    const auto folder = recording::SessionFolder::create(
        options.out, options.participant.id.empty() ? name : name + "_" + options.participant.id);

    RunResult result;
    result.folder = folder.path();
    recording::SessionInfo& info = result.info;
    info.title = plan.title.empty() ? name : plan.title;
    info.program = recording::program_version();
    info.started = recording::iso_now();
    info.command = options.command;
    info.experiment = plan.file;
    info.clock = real ? "real" : "virtual";
    info.seed = std::to_string(plan.seed);
    info.participant = options.participant;
    info.moved_by = plan.moved_by;
    info.study = plan.study;
    if (const int object = plan.scene.object_index(); object >= 0) {
        info.object = plan.scene.bodies[static_cast<size_t>(object)].name;
    }
    const auto servo = make_servo(plan, options.keeper);
    info.devices = records_of(*servo, plan.scene);
    if (!plan.task) info.phases = phases_of(*plan.driver);
    if (plan.task) {
        for (const std::string& phase : plan.task->phases()) info.phases.push_back({phase, 0, 0});
        for (const TaskPlan::Outcome& outcome : plan.task->outcomes)
            info.outcomes.push_back(outcome.name);
        info.messages = plan.task->messages;
        info.resumes = plan.resumes;
    }
    for (const Problem& warning : plan.warnings) info.notes.push_back(warning.text());
    if (plan.movement) {
        info.notes.push_back(fmt::format("{:.1f} % of the movement was bridged",
                                         100 * plan.movement->bridged_share));
    }
    info.inputs = freeze_inputs(plan, folder);
    info.identity = identity_of(info, plan, real);
    folder.write_info(info);

    const recording::LogHead head = log_head(plan.scene, plan.settings, info);
    servo::FrameSink read;
    std::optional<recording::Recorder> recorder;
    if (options.in_place_of_log) {
        read = options.in_place_of_log(folder, info, head);
    } else {
        recorder.emplace(folder.raw_log(), head,
                         real ? recording::Writing::in_thread : recording::Writing::in_place,
                         options.sync);
    }
    result.lock.emplace(folder);
    if (real || options.sync > 0) folder.sync();  // what it is about, before it begins
    std::optional<Outward> outward;               // others must not take a rehearsal for a session
    if (plan.seeing) plan.seeing->restart();
    try {
        if (real && !plan.rig.outlets.empty())
            outward.emplace(plan, fs::path(folder.path()).filename().string());
        servo->activate();
        if (options.check) {
            for (const Problem& warning : options.check(servo->devices()))
                info.notes.push_back(warning.text());
            folder.write_info(info);
        }
    } catch (...) {
        // real devices, what they send to, or the person may refuse: there is no session then
        std::error_code ignored;
        fs::remove_all(folder.path(), ignored);
        throw;
    }
    const Time whole = plan.task ? kLongest : from_seconds(plan.driver->duration());
    result.timing.reserve(static_cast<size_t>(std::min(whole, kLongestTimed) / servo->period()) +
                          2);
    std::atomic<int64_t> reached{0};
    Live* const live = options.live;
    if (live != nullptr) live->prepare(*servo, plan.scene);
    const servo::FrameSink sink = [&](const servo::Frame& frame) {
        if (recorder) {
            recorder->record(frame);
        } else {
            read(frame);
            ++result.ticks;
        }
        if (outward) outward->send(frame);
        if (plan.seeing) plan.seeing->see(frame);
        if (live != nullptr) live->show(frame);
        reached.store(frame.time.count(), std::memory_order_relaxed);
    };
    PhaseDirector phases(info.phases, plan.settings.tick());
    std::optional<TaskDirector> task;
    if (plan.task) task.emplace(*plan.task, plan.seed, plan.settings.tick(), plan.done);
    std::optional<Wait> wait;
    if (plan.task && plan.seeing && !real) wait.emplace(plan.task->stages);
    const servo::Director director = [&](const servo::Frame& last,
                                         std::span<const haptics::Handle> handles,
                                         servo::Commands& commands) {
        if (task && servo->fault()) {
            // without force there are no trials: this one is over
            commands.trial = last.trial;
            commands.phase = last.phase;
            commands.task.attempt = last.task.attempt;
        } else if (task) {
            if (options.keys != nullptr) task->press(options.keys->exchange(0));
            if (const char key = plan.seeing ? plan.seeing->take_key() : '\0'; key != 0)
                task->press(key);
            if (outward) {
                if (const int code = outward->take_trigger(); code != 0) task->trigger(code);
            } else if (!real && simulated_trigger(last, servo->period())) {
                task->trigger(TaskDirector::kAnyTrigger);
            }
            (*task)(last, handles, commands);
        } else {
            phases(last, handles, commands);
        }
        if (wait) wait->look(last, commands);
        commands.stop = commands.stop || (recorder && recorder->failed()) || (wait && wait->over);
        commands.force_off = real && stop.load(std::memory_order_relaxed);
        if (live == nullptr) return;
        commands.stop = commands.stop || live->ended.load(std::memory_order_relaxed);
        commands.rest = live->paused.load(std::memory_order_relaxed);
        commands.abandoned = live->abandoned();
        commands.solver = live->solver.read();
        commands.tuning = live->tune(servo->settings().coupling.tuning(), plan.settings.tick());
        if (plan.settings.proxy.changeable && last.sequence >= 0)
            commands.proxy = live->change_proxy(last);
        commands.friction_scale = live->friction_scale.read();
        if (task) {
            if (live->skip.exchange(false, std::memory_order_relaxed)) task->skip();
            live->done.store(task->share(), std::memory_order_relaxed);
        }
        commands.workspace_rate = live->turn(last, plan.settings.tick());
    };
    const auto stuck = [&](const servo::Timing::Stall& stall) {
        if (!options.stuck) return;
        options.stuck(
            fmt::format("{}. The call has not returned since, so the session ends here. Switch the "
                        "devices off and on; dihaptic recover {} makes the session's files.",
                        servo::describe(stall), folder.path()));
    };
    const auto describe_fault = [&] {
        const haptics::Fault& fault = servo->fault();
        const size_t device = fault.device < 0 ? 0 : static_cast<size_t>(fault.device);
        std::string out =
            haptics::describe(fault, info.devices[device].finger, info.devices[device].model);
        if (const std::string said = servo->devices().explain(static_cast<int>(device));
            fault.device >= 0 && !said.empty())
            out += " Its driver says: " + said;
        const bool stopped = fault.kind == haptics::FaultKind::stopped;
        if (!stopped) out += " The second before it is in fault.csv.";
        if (live != nullptr) return out;  // who steers knows how it goes on
        if (plan.task) {
            out += fmt::format(" dihaptic resume {} goes on with the trials that are left.",
                               folder.path());
        } else if (!stopped) {
            out += " Then start the session again.";
        }
        return out;
    };
    const auto share = [&] {
        return task ? task->share()
                    : static_cast<double>(reached.load(std::memory_order_relaxed)) /
                          static_cast<double>(std::max<int64_t>(1, whole.count()));
    };
    recording::ShowingsWriter showings(folder);
    const auto ended = [&] { return live != nullptr && live->ended; };
    const auto begin = Wall::now();
    {
        const Watcher watcher([&] {
            if (progress) progress(std::min(1.0, share()));
            if (live == nullptr) return;
            while (const auto showing = live->take_showing()) showings.add(*showing);
            showings.flush();
        });
        if (real) {
            const std::atomic<bool> never{false};  // the director stops it, with a last tick
            Time first{0};
            while (true) {
                servo::run_real(*servo, director, sink, first, whole, never, result.timing, stuck);
                servo->rest();
                if (live == nullptr) break;
                if (servo->fault() && !stop) {
                    info.notes.push_back(describe_fault());
                    if (task) task->interrupt();
                    live->tell(info.notes.back());
                } else if (!servo->resting()) {
                    break;
                } else if (task) {
                    task->interrupt();
                }
                first = result.timing.reached + servo->period();
                if (first > whole || !wait_to_go_on(*servo, *live, stop)) break;
            }
        } else {
            servo::run_virtual(*servo, director, sink, whole, stop, &result.timing.ticks);
        }
    }
    result.elapsed = since(begin);
    servo->deactivate();
    if (recorder) recorder->finish();
    if (outward) {
        for (const std::string& failure : outward->finish()) info.notes.push_back(failure);
    }
    result.simulated = seconds(Time(reached.load()));
    if (recorder) {
        result.ticks = recorder->frames();
        result.dropped = recorder->dropped();
    }
    // with a mouse, or a person, there is no more to do than somebody wants to
    const bool unfinished = task ? task->share() < 1 : !plan.open_ended();
    result.interrupted = stop.load() || (ended() && unfinished);
    if (plan.open_ended()) info.phases.back().end = result.simulated;
    if (servo->fault()) {
        result.fault = describe_fault();
        // a session that waited for a remedy has told of it
        if (info.notes.empty() || info.notes.back() != result.fault)
            info.notes.push_back(result.fault);
    }
    if (wait && wait->over) {
        result.interrupted = true;
        result.fault = wait->describe(info.phases);
        info.notes.push_back(result.fault);
    }
    if (result.timing.stall) {
        result.stall = servo::describe(*result.timing.stall);
        info.notes.push_back(result.stall);
    }

    if (result.timing.pauses > 0) info.notes.push_back(servo::describe_pauses(result.timing));

    if (progress && !result.interrupted) progress(1);

    info.ticks = static_cast<int>(result.ticks + result.dropped);
    info.interrupted = result.interrupted;
    info.finished =
        fmt::format("{}, {}, {} not recorded", counted(info.ticks, "tick"),
                    counted(result.timing.overruns, "overrun"), counted(result.dropped, "frame"));
    if (real) info.finished += "; " + servo::describe(result.timing);
    if (result.timing.refusals.any()) {
        info.notes.push_back(
            servo::describe(result.timing.refusals, plan.settings.real_time_priority));
    }
    folder.write_info(info);
    info.state = result.interrupted ? recording::SessionState::interrupted
                                    : recording::SessionState::complete;
    return result;
}

}  // namespace dihaptic::experiment
