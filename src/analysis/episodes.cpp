#include "analysis/episodes.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace dihaptic::analysis {
namespace {

constexpr double kShortestEpisode = 0.02;  // [s]
constexpr double kLettingGo = 0.05;    // fingers that pressed within this time before the flight
                                       // count as having released the object [s]
constexpr double kSlideSpeed = 0.001;  // below this speed the object creeps or rests [m/s]
constexpr double kHandSpeed = 0.05;    // below this speed the hand is still [m/s]

/// The kind of episode to which a sample belongs, if any.
struct State {
    std::optional<rows::EpisodeKind> kind;
    PerFinger<char> touching;
    bool operator==(const State&) const = default;
};

State state_of(const GraspTrace::Sample& s, bool flies) {
    if (!s.awake || !s.X_WB.p.allFinite()) return {};
    if (s.on_support) {
        if (!(s.v_sliding.norm() > kSlideSpeed)) return {};
        return {rows::EpisodeKind::slide, s.touching};
    }
    if (s.touched()) return {rows::EpisodeKind::hold, s.touching};
    if (!flies) return {};
    return {rows::EpisodeKind::flight, s.touching};
}

struct Run {
    State state;
    Range range;
};

/// Returns the runs of samples in one state that last long enough. Two holds, or two slides, with
/// only shorter runs between them are merged into one.
std::vector<Run> runs_of(const GraspTrace& trace, bool flies) {
    const std::vector<GraspTrace::Sample>& samples = trace.samples();
    const auto shortest = static_cast<size_t>(std::ceil(kShortestEpisode / trace.tick()));
    std::vector<Run> out;
    for (size_t first = 0; first < samples.size();) {
        const State state = state_of(samples[first], flies);
        size_t last = first + 1;
        while (last < samples.size() && state_of(samples[last], flies) == state) ++last;
        if (state.kind && last - first >= shortest) {
            const bool goes_on = !out.empty() && out.back().state == state &&
                                 *state.kind != rows::EpisodeKind::flight &&
                                 first - out.back().range.last < shortest;
            if (goes_on) {
                out.back().range.last = last;
            } else {
                out.push_back({state, {first, last}});
            }
        }
        first = last;
    }
    return out;
}

void measure_hold(const GraspTrace& trace, Episode& out) {
    out.slip = 0;
    out.least_slip = std::numeric_limits<double>::infinity();
    for (const size_t finger : out.fingers) {
        const double slip = trace.slip(out.range, finger);
        out.slip = std::max(out.slip, slip);
        out.least_slip = std::min(out.least_slip, slip);
    }
    out.sag = trace.sag(out.range);
    if (out.fingers.size() < 2) return;
    const auto line = [&](const GraspTrace::Sample& s) {
        return Vec3(s.p_WP[out.fingers[1]] - s.p_WP[out.fingers[0]]);
    };
    const GraspTrace::Sample& start = trace.samples()[out.range.first];
    out.turn = out.hand_turn = 0;
    for (size_t i = out.range.first; i < out.range.last; ++i) {
        const GraspTrace::Sample& s = trace.samples()[i];
        const Vec3 a = line(start);
        const Vec3 b = line(s);
        const double turned = std::atan2(a.cross(b).norm(), a.dot(b));
        if (turned <= out.hand_turn) continue;
        out.hand_turn = turned;
        out.turn = angle_between(start.X_WB.R, s.X_WB.R);
    }
}

void measure_slide(const GraspTrace& trace, const ObjectFacts& object, Episode& out) {
    const std::vector<GraspTrace::Sample>& samples = trace.samples();
    const double h = trace.tick();
    out.distance = 0;
    double work = 0, closed_form = 0;
    double moved = 0;  // size of what the balance consists of
    for (size_t i = out.range.first + 1; i < out.range.last; ++i) {
        const GraspTrace::Sample& s = samples[i];
        // the force times h times the mean of the velocities before and after the step is the
        // change of energy
        const Vec3 v = (samples[i - 1].v_sliding + s.v_sliding) / 2;
        out.distance += h * v.norm();
        if (s.support < 0)
            continue;  // the object left its support for less time than an episode must last
        Vec3 load = s.weight_scale * object.mass * object.gravity;
        for (const size_t finger : out.fingers) load -= s.f_sent_W[finger];
        double mu = s.friction_scale * s.support_friction_scale;
        mu *=
            object.friction.empty() ? kUnmeasured : object.friction[static_cast<size_t>(s.support)];
        work += h * load.dot(v);
        moved += h * std::abs(load.dot(v));
        closed_form += h * mu * std::max(0.0, -load.dot(s.n_support)) * v.norm();
    }
    const auto energy = [&](size_t i) {
        const Vec3& v = samples[i].v_sliding;
        return object.mass * samples[i].mass_scale.cwiseProduct(v).dot(v) / 2;
    };
    const double before = energy(out.range.first), after = energy(out.range.last - 1);
    work += before - after;
    moved += before + after;
    // while fingers carry most of the object and slip on it, this friction is a small difference
    constexpr double kLeastShare = 0.1;
    if (closed_form > kLeastShare * moved) out.friction_ratio = work / closed_form;
}

void measure_flight(const GraspTrace& trace, const ObjectFacts& object, Episode& out) {
    const std::vector<GraspTrace::Sample>& samples = trace.samples();
    const double h = trace.tick();
    const size_t first = out.range.first;
    const Vec3 p0 = samples[first].X_WB.p;
    // initial velocity of the parabola through the object's first two positions
    const Vec3 v0 = (samples[first + 1].X_WB.p - p0) / h - object.gravity * h / 2;
    // in its first airborne tick, the object is already moving along its path
    const double let_go_at = samples[first > 0 ? first - 1 : 0].X_WB.p.z();
    out.rise = out.off_path = 0;
    for (size_t i = first; i < out.range.last; ++i) {
        const double t = static_cast<double>(i - first) * h;
        const Vec3 path = p0 + t * v0 + t * t / 2 * object.gravity;
        const double off = (samples[i].X_WB.p - path).norm();
        out.off_path = std::isnan(off) ? off : std::max(out.off_path, off);
        out.rise = std::max(out.rise, samples[i].X_WB.p.z() - let_go_at);
    }
    if (first == 0) return;
    const GraspTrace::Sample& release = samples[first - 1];
    const size_t back = std::min(first, static_cast<size_t>(std::ceil(kLettingGo / h)));
    for (size_t finger = 0; finger < trace.fingers(); ++finger) {
        const bool let_go =
            std::any_of(samples.begin() + static_cast<std::ptrdiff_t>(first - back),
                        samples.begin() + static_cast<std::ptrdiff_t>(first),
                        [&](const GraspTrace::Sample& s) { return s.touching[finger] != 0; });
        if (let_go) out.fingers.push_back(finger);
    }
    if (out.fingers.empty()) return;
    Vec3 hand = Vec3::Zero();
    for (const size_t finger : out.fingers)
        hand += release.v_WH[finger] / static_cast<double>(out.fingers.size());
    out.release_speed = release.v_WB.norm();
    if (hand.norm() > kHandSpeed) out.release_ratio = release.v_WB.dot(hand) / hand.squaredNorm();
}

}  // namespace

std::vector<Episode> find_episodes(const GraspTrace& trace, const ObjectFacts& object) {
    std::vector<Episode> out;
    for (const Run& run : runs_of(trace, object.flies)) {
        Episode episode;
        episode.kind = *run.state.kind;
        episode.range = run.range;
        episode.start = trace.samples()[run.range.first].time;
        episode.end = trace.samples()[run.range.last - 1].time;
        for (size_t finger = 0; finger < run.state.touching.size(); ++finger) {
            if (run.state.touching[finger]) episode.fingers.push_back(finger);
        }
        switch (episode.kind) {
            case rows::EpisodeKind::hold:
                measure_hold(trace, episode);
                break;
            case rows::EpisodeKind::slide:
                measure_slide(trace, object, episode);
                break;
            case rows::EpisodeKind::flight:
                measure_flight(trace, object, episode);
                break;
        }
        out.push_back(std::move(episode));
    }
    return out;
}

}  // namespace dihaptic::analysis
