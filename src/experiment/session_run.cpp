#include "experiment/session_run.h"

#include <fmt/format.h>

#include <bit>
#include <chrono>
#include <condition_variable>
#include <filesystem>
#include <thread>

#include "base/field_table.h"

namespace dihaptic::experiment {
namespace {

/// Equal to the bit, so that a NaN equals itself.
template <class Vector>
bool same_bits(const Vector& a, const Vector& b) {
    for (Eigen::Index i = 0; i < a.size(); ++i) {
        if (std::bit_cast<uint64_t>(a[i]) != std::bit_cast<uint64_t>(b[i])) return false;
    }
    return true;
}

namespace fs = std::filesystem;
using Wall = std::chrono::steady_clock;

double since(Wall::time_point begin) {
    return std::chrono::duration<double>(Wall::now() - begin).count();
}

/// Phases by time, from the driver or from a recorded session: the director of every session so
/// far.
class PhaseDirector {
  public:
    PhaseDirector(std::vector<recording::PhaseInfo> phases, double tick)
        : phases_(std::move(phases)), tick_(tick) {}

    void operator()(const servo::Frame& last, std::span<const haptics::Handle>,
                    servo::Commands& commands) noexcept {
        const double now = last.sequence < 0 ? 0 : seconds(last.time) + tick_;
        while (phase_ + 1 < phases_.size() && now >= phases_[phase_].end - tick_ / 2) ++phase_;
        commands.trial = 1;
        commands.phase = static_cast<int32_t>(phase_);
    }

  private:
    std::vector<recording::PhaseInfo> phases_;
    double tick_;
    size_t phase_ = 0;
};

std::vector<recording::PhaseInfo> phases_of(const hand::Driver& driver) {
    std::vector<recording::PhaseInfo> out;
    for (const hand::Driver::Phase& phase : driver.phases())
        out.push_back({phase.name, phase.start, phase.end});
    return out;
}

/// The session keeps its own copies of the meshes: the scene that it froze names them.
void freeze_meshes(scene::Scene& scene, const std::string& from,
                   const recording::SessionFolder& folder) {
    int count = 0;
    const auto freeze = [&](scene::Shape& shape) {
        if (shape.kind != scene::ShapeKind::mesh) return;
        const std::string name =
            fmt::format("mesh-{}-{}", ++count, fs::path(shape.file).filename().string());
        fs::copy_file(fs::path(from) / shape.file, folder.file(name));
        shape.file = name;
    };
    for (scene::Body& body : scene.bodies) freeze(body.shape);
    for (scene::Finger& finger : scene.fingers) freeze(finger.shape);
}

std::string scene_folder(const Plan& plan) {
    // where the scene's meshes are relative to
    if (kind_of(plan.file) == FileKind::scene) return fs::path(plan.file).parent_path().string();
    Diagnostics diagnostics;
    const Experiment experiment = read_experiment(plan.file, diagnostics);
    return (fs::path(plan.file).parent_path() / fs::path(experiment.scene).parent_path()).string();
}

void freeze_inputs(const Plan& plan, const recording::SessionFolder& folder) {
    scene::Scene scene = plan.scene;
    scene.settings = {};  // resolved, in settings.yaml
    scene.hand = write_fields(plan.hand);
    freeze_meshes(scene, scene_folder(plan), folder);
    write_file(to_yaml(write_fields(scene)), folder.file("scene.yaml"));
    write_file(to_yaml(write_fields(plan.rig)), folder.file("rig.yaml"));
    write_file(to_yaml(write_fields(plan.settings)), folder.file("settings.yaml"));
    write_csv(list_fields(plan.settings, plan.origins), folder.file("settings.csv"));
    if (!plan.movement) return;
    fs::copy_file(plan.movement->file, folder.file("movement.csv"));
    Table faults;
    faults.columns = {{"start_s", "last good frame before"},
                      {"end_s", "first good frame after"},
                      {"finger", "empty: all"},
                      {"fault", "what the tracker lost"},
                      {"line", "of movement.csv"},
                      {"distance_mm", "between the good frames"}};
    for (const hand::Fault& fault : plan.movement->faults) {
        faults.rows.push_back(
            {fault.start, fault.end,
             fault.finger < 0 ? "" : plan.movement->fingers[static_cast<size_t>(fault.finger)],
             std::string(enum_name(fault.kind)), static_cast<double>(fault.line),
             fault.distance * 1e3});
    }
    write_csv(faults, folder.file("movement-faults.csv"));
}

recording::LogHead log_head(const scene::Scene& scene, const servo::Settings& settings) {
    recording::LogHead head;
    head.tick = settings.tick();
    head.fingers = scene::finger_names(scene);
    for (const scene::Body& body : scene.bodies) head.bodies.push_back(body.name);
    return head;
}

/// Calls `progress` about ten times a second from a thread of its own while something runs.
class Watcher {
  public:
    Watcher(const std::atomic<int64_t>& reached, Time whole, const Progress& progress) {
        if (!progress) return;
        thread_ = std::thread([this, &reached, whole, progress] {
            std::unique_lock lock(mutex_);
            while (!done_) {
                condition_.wait_for(lock, std::chrono::milliseconds(100));
                progress(
                    std::min(1.0, static_cast<double>(reached.load(std::memory_order_relaxed)) /
                                      static_cast<double>(std::max<int64_t>(1, whole.count()))));
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

}  // namespace

RunResult run_session(const Plan& plan, const RunOptions& options, const std::atomic<bool>& stop,
                      const Progress& progress) {
    const bool real = options.clock == Clock::real;
    const std::string name = fs::path(plan.file).stem().string();
    const auto folder = recording::SessionFolder::create(
        options.out, options.participant.id.empty() ? name : name + "_" + options.participant.id);

    recording::SessionInfo info;
    info.title = plan.title.empty() ? name : plan.title;
    info.program = recording::program_version();
    info.started = recording::iso_now();
    info.command = options.command;
    info.experiment = plan.file;
    info.clock = real ? "real" : "virtual";
    info.seed = std::to_string(plan.seed);
    info.participant = options.participant;
    if (const int object = plan.scene.object_index(); object >= 0) {
        info.object = plan.scene.bodies[static_cast<size_t>(object)].name;
    }
    const auto servo = make_servo(plan);
    for (int i = 0; i < servo->devices().size(); ++i) {
        const devices::DeviceInfo& device = servo->devices().info(i);
        info.devices.push_back(
            {plan.scene.fingers[static_cast<size_t>(i)].name, device.model, device.peak_force});
    }
    info.phases = phases_of(*plan.driver);
    for (const Problem& warning : plan.warnings) info.notes.push_back(warning.text());
    if (plan.movement) {
        info.notes.push_back(fmt::format("{:.1f} % of the movement was bridged",
                                         100 * plan.movement->bridged_share));
    }
    freeze_inputs(plan, folder);
    folder.write_info(info);

    RunResult result;
    result.folder = folder.path();
    recording::Recorder recorder(
        folder.raw_log(), log_head(plan.scene, plan.settings),
        real ? recording::Writing::in_thread : recording::Writing::in_place);
    servo->activate();
    const Time whole = from_seconds(plan.driver->duration());
    result.tick_times.reserve(static_cast<size_t>(whole / servo->period()) + 2);
    std::atomic<int64_t> reached{0};
    const servo::FrameSink sink = [&](const servo::Frame& frame) {
        recorder.record(frame);
        reached.store(frame.time.count(), std::memory_order_relaxed);
    };
    PhaseDirector phases(info.phases, plan.settings.tick());
    const servo::Director director = [&](const servo::Frame& last,
                                         std::span<const haptics::Handle> handles,
                                         servo::Commands& commands) {
        phases(last, handles, commands);
        commands.stop = recorder.failed();
    };
    const auto begin = Wall::now();
    {
        const Watcher watcher(reached, whole, progress);
        if (real) {
            result.overruns =
                servo::run_real(*servo, director, sink, whole, stop, result.tick_times, reached)
                    .overruns;
        } else {
            servo::run_virtual(*servo, director, sink, whole, stop, &result.tick_times);
        }
    }
    result.elapsed = since(begin);
    servo->deactivate();
    recorder.finish();
    result.simulated = seconds(Time(reached.load()));
    result.ticks = recorder.frames();
    result.dropped = recorder.dropped();
    result.interrupted = stop.load();

    info.state = result.interrupted ? recording::SessionState::interrupted
                                    : recording::SessionState::complete;
    info.finished = fmt::format("{} ticks, {} overruns, {} frames not recorded", result.ticks,
                                result.overruns, result.dropped);
    folder.write_info(info);
    return result;
}

ReplayResult replay_session(const std::string& path, const std::atomic<bool>& stop,
                            const Progress& progress) {
    const auto folder = recording::SessionFolder::open(path);
    const recording::SessionInfo info = folder.read_info();
    Diagnostics diagnostics;
    const scene::Scene scene = scene::read_scene(folder.file("scene.yaml"), diagnostics);
    const rig::Rig rig = rig::read_rig(folder.file("rig.yaml"), diagnostics);
    servo::Settings settings;
    read_fields(settings, read_yaml(folder.file("settings.yaml")), diagnostics);
    diagnostics.throw_if_errors();

    recording::RawLogReader log(folder.raw_log());
    const servo::Frame* recorded = log.next();
    devices::Context context;
    context.tick = settings.tick();
    context.recording = [&](Time, std::span<devices::Reading> readings) {
        if (recorded == nullptr) return false;
        for (size_t i = 0; i < readings.size(); ++i) {
            const servo::FingerFrame& finger = recorded->fingers[i];
            readings[i] = {finger.p_DH, finger.v_DH, finger.buttons, 0};
        }
        return true;
    };
    std::vector<devices::DeviceConfig> configs;
    for (const recording::DeviceRecord& device : info.devices) {
        Node options = Node::mapping();
        options.set("peak_force_N", Node::of(fmt::format("{}", device.peak_force)));
        configs.push_back({device.finger, {}, options});
    }
    auto group = devices::find_backend("replay")->make(configs, context);
    servo::Servo servo(scene, settings, std::move(group),
                       rig::poses(rig, scene::finger_names(scene)));
    servo.activate();

    ReplayResult result;
    PhaseDirector director(info.phases, settings.tick());
    const auto size = static_cast<double>(fs::file_size(folder.raw_log()));
    const auto begin = Wall::now();
    while (recorded != nullptr && !stop.load()) {
        const servo::Frame& frame = servo.tick(recorded->time, director);
        bool same = frame.sequence == recorded->sequence;
        for (size_t i = 0; i < frame.fingers.size(); ++i) {
            const servo::FingerFrame& a = frame.fingers[i];
            const servo::FingerFrame& b = recorded->fingers[i];
            same = same && same_bits(a.f_sent_W, b.f_sent_W) &&
                   same_bits(a.f_asked_W, b.f_asked_W) && same_bits(a.p_WP, b.p_WP);
        }
        for (size_t i = 0; i < frame.bodies.size(); ++i) {
            const Pose& a = frame.bodies[i].X_WB;
            const Pose& b = recorded->bodies[i].X_WB;
            same = same && same_bits(a.p, b.p) && same_bits(a.R.coeffs(), b.R.coeffs());
        }
        if (!same) {
            if (result.different_ticks++ == 0) result.first_difference = seconds(recorded->time);
        }
        ++result.ticks;
        if (progress && result.ticks % 2000 == 0)
            progress(std::min(0.99, static_cast<double>(result.ticks) * 1000 / size));
        recorded = log.next();
    }
    servo.deactivate();
    result.elapsed = since(begin);
    return result;
}

}  // namespace dihaptic::experiment
