#include "measure/grasp.h"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>

#include "base/figure.h"
#include "model/grasp.h"
#include "model/gravity.h"
#include "model/minimum_jerk.h"

namespace dihaptic::measure {
namespace {

constexpr std::array kCalmList{100,  200,  300,  400,  500,  600,  800, 1000,
                               1500, 2000, 3000, 4000, 5000, 6000, 8000};
constexpr double kLastSeconds = 3;  // the end of the hold, which is judged once all has settled [s]
using model::kGravity;

double degrees(double rad) {
    return rad * 180 / std::numbers::pi;
}

BenchSetup with(BenchSetup setup, double k, Fingering fingering = Fingering::ideal,
                Row row = Row::ideal) {
    setup.settings.coupling.stiffness = k;
    setup.fingering = fingering;
    setup.row = row;
    return setup;
}

/// Returns the peak force of a spring of stiffness K that acts continuously, without sampling,
/// which is the lower bound of the kick [N].
double perfect_peak(const BenchSetup& setup, double speed) {
    const double h = 1e-6;
    const double mass = 0.075;
    const double k = setup.settings.coupling.stiffness;
    double x = -kStartGap, v = 0, peak = 0;
    const double end = kStartGap + setup.squeeze;
    const auto steps = static_cast<int>((end / speed + 1) / h);
    for (int i = 0; i < steps; ++i) {
        const double t = i * h;
        const bool running = speed * t < end;
        const double target = -kStartGap + std::min(speed * t, end);
        const double push = x > 0 ? k * x : 0;
        peak = std::max(peak, push);
        v += h / mass *
             (setup.impedance.stiffness * (target - x) +
              setup.impedance.damping * ((running ? speed : 0) - v) - push);
        x += h * v;
    }
    return peak;
}

/// Returns the mean of the normal forces along the grasp axis, from statics [N]. Pads keep the
/// block upright. Between two points, the block turns until the line between the contacts is
/// parallel to the line between the targets.
double closed_form_grip(const BenchSetup& setup) {
    if (setup.settings.proxy.kind == scene::ProxyKind::rigid) return press_force(setup);
    const hand::HandSpec hand = grasp_hand(setup);
    const Vec3 off = hand.fingers[1].offset - hand.fingers[0].offset;
    const Vec3 contacts = off + Vec3(kBlockSize, 0, 0);
    const Vec3 targets = off + Vec3(kBlockSize - 2 * setup.squeeze, 0, 0);
    const double slant =
        kBlockSize / contacts.norm();  // cosine of the angle between the grasp axis and the normal
    BenchSetup along = setup;
    along.squeeze = (contacts.norm() - targets.norm()) / 2;
    return slant * slant * press_force(along);
}

/// Returns figures that contain only the setup, without results.
GraspFigures described(const BenchSetup& base) {
    const frame::Settings& settings = base.settings;
    GraspFigures out;
    out.coupling = settings.coupling.kind;
    out.solver = settings.dynamics.solver;
    out.proxy = settings.proxy.kind;
    out.point_friction = settings.proxy.friction;
    out.damping = fmt::format("{:g} s * K",
                              haptics::damping(with(base, 1).settings.coupling, settings.step()));
    out.mass = base.mass;
    out.friction = base.friction;
    out.rate = settings.rate;
    return out;
}

}  // namespace

HoldFigures measure_hold(const BenchSetup& setup) {
    return measure_hold(setup, grasp_scene(setup));
}

HoldFigures measure_hold(const BenchSetup& setup, const scene::Scene& scene) {
    Bench bench(scene, grasp_hand(setup), setup);
    analysis::GraspTrace trace(1, setup.settings.tick());
    bench.run([&](const frame::Frame& frame) { trace.add(frame); });

    const analysis::Range lift = trace.of_phase(kRise);
    const analysis::Range hold = trace.of_phase(kHold);
    const double end = bench.driver().phases()[kHold].end;
    const analysis::Range settled = trace.between(end - kLastSeconds, end);
    const double k = setup.settings.coupling.stiffness;

    HoldFigures out;
    out.k = k;
    out.fingering = setup.fingering;
    const size_t lift_off = trace.lift_off();
    const double risen = trace.samples()[hold.first].X_WB.p.z() - kBlockSize / 2;
    out.held =
        trace.all_touching({lift_off, hold.last}) && risen >= 0.09 && trace.sag(hold) > -0.001;
    out.lift_slip_mm = trace.slip(lift) * 1e3;
    out.slip_mm = trace.slip(hold) * 1e3;
    out.z_rms_um = trace.height_rms(settled) * 1e6;
    out.z_pp_um = trace.height_range(settled) * 1e6;
    out.tilt_rms_deg = degrees(trace.axis_tilt_rms(settled));
    out.turn_deg = degrees(trace.turn(hold));
    out.hf_force_n = trace.force_above_5_hz(settled);
    out.weight_ratio = trace.weight_felt(settled) / (setup.mass * kGravity);
    out.grip_ratio = trace.mean_grip(settled) / closed_form_grip(setup);
    return out;
}

bool calm_grasp(const HoldFigures& hold, double grip_slack) {
    return hold.held && hold.hf_force_n < 0.02 && std::abs(hold.weight_ratio - 1) < 0.005 &&
           std::abs(hold.grip_ratio - 1) < 0.02 + grip_slack;
}

bool calm_wall(const BenchSetup& setup) {
    Bench bench(wall_scene(setup), wall_hand(setup), setup);
    analysis::GraspTrace trace(-1, setup.settings.tick());
    bench.run([&](const frame::Frame& frame) { trace.add(frame); });
    const double end = bench.driver().duration();
    const analysis::Range settled = trace.between(end - kLastSeconds, end);
    const double expected = press_force(setup);
    return trace.force_above_5_hz(settled) < 0.02 &&
           std::abs(trace.mean_force(settled) / expected - 1) < 0.02;
}

KickFigures measure_kick(BenchSetup setup, double speed) {
    hand::HandSpec hand = wall_hand(setup);
    const double way = kStartGap + setup.squeeze;
    // wait first, because real devices raise their force slowly
    hand.script = {{"wait", 0.25, {}, Vec3::Zero(), false},
                   {"press", way / speed, {}, {way, 0, 0}, true},
                   {"stay", 1, {}, Vec3::Zero(), false},
                   {"leave", way / speed, {}, {-way, 0, 0}, true},
                   {"away", 0.2, {}, Vec3::Zero(), false}};
    Bench bench(wall_scene(setup), hand, setup);
    constexpr int kLeave = 3;  // phase
    KickFigures out;
    out.k = setup.settings.coupling.stiffness;
    out.speed = speed;
    double peak = 0;
    double first_force = 0;
    double first_depth = 0;
    int ticks_since_touch = -1;
    bench.run([&](const frame::Frame& frame) {
        const frame::FingerFrame& finger = frame.fingers[0];
        const double push = -finger.f_sent_W.x();
        const double depth = finger.p_WH.x() + reach(setup);
        if (frame.phase < kLeave) {
            peak = std::max(peak, push);
            if (ticks_since_touch >= 0) ++ticks_since_touch;
            if (ticks_since_touch < 0 && finger.normal_force > 0) {
                ticks_since_touch = 0;
                first_force = push;
                first_depth = depth;
            } else if (ticks_since_touch == 1) {
                first_depth =
                    std::max(first_depth, depth);  // depth reached while the first force was held
            }
        } else {
            out.leave_pull_n = std::max(out.leave_pull_n, -push);
        }
    });
    out.kick_ratio = peak / perfect_peak(setup, speed);
    out.touch_step_n = std::max(0.0, first_force - out.k * first_depth);
    return out;
}

double measure_drag(const BenchSetup& setup) {
    scene::Scene scene = wall_scene(setup);
    scene.bodies[0].position.x() += 10;
    const double way = 0.2;
    hand::HandSpec hand;
    hand.script = {{"move", model::kMinimumJerkPeak * way / 0.5, {}, {0, way, 0}, false},
                   {"rest", 0.2, {}, Vec3::Zero(), false}};
    Bench bench(scene, hand, setup);
    double peak = 0;
    bench.run([&](const frame::Frame& frame) {
        peak = std::max(peak, frame.fingers[0].f_sent_W.norm());
    });
    return peak;
}

std::pair<double, double> measure_torque(const BenchSetup& setup) {
    Bench bench(grasp_scene(setup), grasp_hand(setup), setup);
    analysis::GraspTrace trace(1, setup.settings.tick());
    const double begin = bench.driver().phases()[kHold].start + 2;
    const double tick = setup.settings.tick();
    const dynamics::BodyIndex block{1};
    bench.run(
        [&](const frame::Frame& frame) { trace.add(frame); },
        [&](const frame::Frame& last, std::span<const frame::Handle>, frame::Commands& commands) {
            const double now = static_cast<double>(last.sequence + 1) * tick;
            if (now >= begin - tick / 2 && now < begin + 0.2 - tick / 2) {
                frame::add(commands.task.loads, {block.value, Vec3::Zero(), Vec3(0.02, 0, 0)});
            }
        });
    const size_t start = trace.between(begin, begin).first - 1;
    const size_t end = trace.between(begin + 0.2, begin).first - 1;
    const size_t after = trace.between(begin + 1.2, begin).first - 1;
    return {degrees(std::abs(trace.turn_at(start, end))),
            degrees(std::abs(trace.turn_at(start, after)))};
}

double torsion_limit(const BenchSetup& setup) {
    const double most = setup.friction * closed_form_grip(setup);
    const double weight = setup.mass * kGravity / 2;
    return 2 * setup.soft_radius * std::sqrt(most * most - weight * weight);
}

double measure_torsion_limit(const BenchSetup& base) {
    BenchSetup setup = base;
    setup.hold_time = 8;
    Bench bench(grasp_scene(setup), grasp_hand(setup), setup);
    analysis::GraspTrace trace(1, setup.settings.tick());
    const double begin = bench.driver().phases()[kHold].start + 1;
    const double limit = torsion_limit(setup);
    // the torque rises from 0.5 to 1.2 times the limit
    const auto torque_at = [&](double now) { return limit * (0.5 + 0.1 * (now - begin)); };
    double let_go = 0;
    size_t start = 0;
    bench.run(
        [&](const frame::Frame& frame) {
            trace.add(frame);
            const double now = seconds(frame.time);
            if (now < begin || let_go > 0) return;
            const size_t last = trace.samples().size() - 1;
            if (start == 0) start = last;
            if (degrees(std::abs(trace.turn_at(start, last))) > 0.1) let_go = torque_at(now);
        },
        [&](const frame::Frame& last, std::span<const frame::Handle>, frame::Commands& commands) {
            const double now = static_cast<double>(last.sequence + 1) * setup.settings.tick();
            if (now < begin || let_go > 0) return;
            frame::add(commands.task.loads, {1, Vec3::Zero(), Vec3(torque_at(now), 0, 0)});
        });
    return let_go / limit;
}

double measure_soft_turn(const BenchSetup& setup, double share) {
    Bench bench(grasp_scene(setup), grasp_hand(setup), setup);
    analysis::GraspTrace trace(1, setup.settings.tick());
    const double begin = bench.driver().phases()[kHold].start + 1;
    const Vec3 torque(share * torsion_limit(setup), 0, 0);
    bench.run(
        [&](const frame::Frame& frame) { trace.add(frame); },
        [&](const frame::Frame& last, std::span<const frame::Handle>, frame::Commands& commands) {
            const double now = static_cast<double>(last.sequence + 1) * setup.settings.tick();
            if (now >= begin && now < begin + 1)
                frame::add(commands.task.loads, {1, Vec3::Zero(), torque});
        });
    return degrees(trace.turn(trace.between(begin, begin + 1)));
}

double highest_calm(const std::function<bool(double k)>& calm) {
    double highest = 0;
    for (const int k : kCalmList) {
        if (!calm(k)) break;
        highest = k;
    }
    return highest;
}

GraspFigures bench_grasp(const BenchSetup& base, const Progress& progress) {
    GraspFigures out = described(base);
    constexpr std::array kHoldK{300.0, 600.0, 1000.0, 2000.0, 4000.0};
    const double steps = 3 * kHoldK.size() + 4 + 6 + 9 + 2;
    double done = 0;
    const auto say = [&](const std::string& what) {
        if (progress) progress(what, done++ / steps);
    };
    for (const Fingering fingering : {Fingering::ideal, Fingering::real, Fingering::off_centre}) {
        for (const double k : kHoldK) {
            say(fmt::format("hold, {} fingering, K {}", enum_name(fingering), k));
            out.hold.push_back(measure_hold(with(base, k, fingering)));
        }
    }
    for (const double k : {300.0, 600.0, 1000.0, 2000.0}) {
        say(fmt::format("slow dynamics, K {}", k));
        BenchSetup slow = with(base, k);
        slow.settings.dynamics.every = 10;
        const HoldFigures hold = measure_hold(slow);
        out.slow_dynamics.push_back({k, hold.held, hold.slip_mm, hold.hf_force_n});
    }
    const auto calm = [&](Row row) {
        say("calm stiffness of a held block");
        return highest_calm([&](double k) {
            return calm_grasp(measure_hold(with(base, k, Fingering::offset, row)));
        });
    };
    const auto wall = [&](Row row) {
        say("calm stiffness of a wall");
        return highest_calm(
            [&](double k) { return calm_wall(with(base, k, Fingering::ideal, row)); });
    };
    out.calm_k = calm(Row::ideal);
    out.calm_k_delay = calm(Row::delay);
    out.calm_k_premium = calm(Row::premium);
    out.wall_k = wall(Row::ideal);
    out.wall_k_delay = wall(Row::delay);
    out.wall_k_premium = wall(Row::premium);
    say("torque");
    std::tie(out.torque_turn_deg, out.torque_turn_after_deg) = measure_torque(with(base, 1000));
    const bool apart = base.settings.proxy.kind == scene::ProxyKind::point &&
                       base.settings.proxy.friction == frame::PointFriction::apart;
    if (!apart) {
        BenchSetup soft = with(base, 1000);
        soft.soft_radius = kSoftRadius;
        out.torsion_limit_ratio = measure_torsion_limit(soft);
    }
    for (const double k : {300.0, 1000.0, 2000.0}) {
        for (const double speed : {0.1, 0.3, 0.5}) {
            say(fmt::format("touch at {} m/s, K {}", speed, k));
            out.kick.push_back(measure_kick(with(base, k), speed));
        }
    }
    say("drag");
    out.drag_n = measure_drag(base);
    return out;
}

std::string to_json(const GraspFigures& figures) {
    return FigureJson<nlohmann::ordered_json>::of(figures).dump(2) + "\n";
}

}  // namespace dihaptic::measure
