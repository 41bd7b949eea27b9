#include "session/replay.h"

#include <algorithm>
#include <chrono>
#include <cstring>

#include "recording/log_scene.h"
#include "recording/seal.h"

namespace dihaptic::session {
namespace {

using Wall = std::chrono::steady_clock;

/// Compares bit by bit, so that a NaN equals itself.
bool same(const frame::Frame& frame, const frame::Frame& recorded) {
    const std::vector<double> a = outcome_of(frame);
    const std::vector<double> b = outcome_of(recorded);
    return frame.sequence == recorded.sequence && a.size() == b.size() &&
           std::memcmp(a.data(), b.data(), a.size() * sizeof(double)) == 0;
}

/// Checks that the log's fingers, bodies and devices match the scene's one to one.
void check(const recording::LogHead& head, const scene::Scene& scene, const std::string& file) {
    recording::check_fits(head, scene, file);
    const auto holds = [](const recording::DeviceRecord& device, const std::string& finger) {
        return device.finger == finger;
    };
    if (std::equal(head.devices.begin(), head.devices.end(), head.fingers.begin(),
                   head.fingers.end(), holds))
        return;
    throw Error({file, 0}, "devices", "do not match the session's fingers, in order",
                "Restore this session's own log.");
}

/// The inputs of the session, read from its own files.
struct Inputs {
    scene::Scene scene;
    rig::Rig rig;
    frame::Settings settings;
};

Inputs read_inputs(const recording::SessionFolder& folder, const recording::LogHead& head,
                   Diagnostics& diagnostics) {
    diagnostics.add(folder.changed(head.inputs, Severity::error));
    diagnostics.throw_if_errors();
    Inputs out;
    out.scene = scene::read_scene(folder.file("scene.yaml"), diagnostics);
    out.rig = rig::read_rig(folder.file("rig.yaml"), diagnostics);
    read_fields(out.settings, read_yaml(folder.file("settings.yaml")), diagnostics);
    diagnostics.throw_if_errors();
    check(head, out.scene, folder.raw_log());
    return out;
}

/// Restores the devices' readings of the recorded tick.
void read_again(const frame::Frame& recorded, const recording::LogHead& head,
                std::span<devices::Reading> readings) {
    auto turn = recorded.turns.begin();
    for (size_t i = 0; i < readings.size(); ++i) {
        const frame::FingerFrame& finger = recorded.fingers[i];
        readings[i] = {finger.p_DH, finger.v_DH, finger.buttons, finger.status & kStatusByDevice};
        if (!head.devices[i].measures_orientation) continue;
        readings[i].R_DH = turn->R_DH;
        readings[i].w_DH = turn->w_DH;
        ++turn;
    }
}

/// Restores the orders that the director gave in the recorded tick.
void order_again(const frame::Frame& recorded, frame::Commands& commands) {
    commands.force_off = (recorded.status & kStopped) != 0;
    commands.rest = (recorded.status & kPaused) != 0;
    // the duration was not recorded, but does not matter
    commands.abandoned = (recorded.status & kAbandoned) != 0 ? 1 : 0;
    commands.knobs = recorded;
    commands.trial = recorded.trial;
    commands.phase = recorded.phase;
    commands.task = recorded.task;
}

/// Describes gaps in the log and checks whether the session's state explains them.
void judge_log(recording::RawLogReader& log, const recording::SessionInfo& info,
               ReplayResult& result) {
    const recording::LogHealth& health = log.read_to_end();  // finds losses after a gap, too
    result.log = recording::describe(health, info.ticks, log.head().planned());
    // the log of a recovered session may lack its end mark; any other log must have the mark
    const bool endless = info.state == recording::SessionState::recovered && !health.complete;
    result.damaged = !health.gaps.empty() || !health.strays.empty() ||
                     health.last_tick + 1 < info.ticks || (!endless && health.damaged(info.ticks));
}

}  // namespace

std::vector<double> outcome_of(const frame::Frame& frame) {
    std::vector<double> out;
    out.reserve(13 * frame.fingers.size() + 6 * frame.turns.size() + 7 * frame.bodies.size() +
                6 * frame.joints.size());
    const auto add = [&](const auto& vector) {
        out.insert(out.end(), vector.data(), vector.data() + vector.size());
    };
    for (const frame::FingerFrame& finger : frame.fingers) {
        add(finger.f_sent_W);
        add(finger.f_asked_W);
        add(finger.p_WP);
        add(finger.R_WP.coeffs());
    }
    for (const frame::TurnFrame& turn : frame.turns) {
        add(turn.t_sent_W);
        add(turn.t_asked_W);
    }
    for (const frame::BodyFrame& body : frame.bodies) {
        add(body.X_WB.p);
        add(body.X_WB.R.coeffs());
    }
    for (const frame::JointFrame& joint : frame.joints) {
        add(joint.f_B_W);
        add(joint.t_B_W);
    }
    return out;
}

ReplayResult replay_session(const std::string& path, const std::atomic<bool>& stop,
                            const Progress& progress) {
    const auto folder = recording::SessionFolder::open(path);
    recording::RawLogReader log(folder.raw_log());
    const recording::LogHead& head = log.head();
    Diagnostics diagnostics(UnknownKeys::are_left_out);
    const recording::SessionInfo info = folder.read_info(head, diagnostics);
    ReplayResult result;
    const Inputs inputs = read_inputs(folder, head, diagnostics);
    // a replay does not use the tables
    diagnostics.add(recording::broken_own_seal(folder, info, Severity::warning));
    result.warnings = diagnostics.problems();
    result.version = recording::describe_version(log.health());
    result.program = info.program;

    const frame::Frame* recorded = log.next();
    devices::Context context;
    context.tick = inputs.settings.tick();
    context.recording.devices.assign(head.devices.begin(), head.devices.end());
    context.recording.read = [&](Time, std::span<devices::Reading> readings) {
        if (recorded != nullptr) read_again(*recorded, head, readings);
        return recorded != nullptr;
    };
    servo::Servo servo(
        inputs.scene, inputs.settings, devices::find_backend("replay")->make({}, context),
        rig::poses(inputs.rig, scene::finger_names(inputs.scene)), rig::wall_box(inputs.rig));
    servo.activate();
    const frame::Director director = [&](const frame::Frame&, std::span<const frame::Handle>,
                                         frame::Commands& commands) {
        order_again(*recorded, commands);
    };
    const auto begin = Wall::now();
    while (recorded != nullptr && log.health().gaps.empty() && !stop.load()) {
        if (recorded->status & kResumed) servo.resume();
        servo.note_timing(
            {recorded->lateness, recorded->tick_duration, (recorded->status & kOverrun) != 0});
        if (!same(servo.tick(recorded->time, director), *recorded) && result.different_ticks++ == 0)
            result.first_difference = seconds(recorded->time);
        ++result.ticks;
        if (progress && result.ticks % 2000 == 0) progress(log.share());
        recorded = log.next();
    }
    servo.deactivate();
    result.elapsed = std::chrono::duration<double>(Wall::now() - begin).count();
    result.interrupted = stop.load();
    if (result.interrupted) return result;
    judge_log(log, info, result);
    if (progress) progress(1);
    return result;
}

}  // namespace dihaptic::session
