#include "analysis/generalisation.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>

#include "analysis/adaptation.h"
#include "base/geometry.h"
#include "base/unmeasured.h"

namespace dihaptic::analysis {
namespace {

struct RunningMean {
    double sum = 0;
    int count = 0;
    void add(double x) {
        sum += x;
        ++count;
    }
    double value() const { return count == 0 ? kUnmeasured : sum / count; }
};

/// The reaches in one condition of a round.
struct Direction {
    std::string condition;
    Vec3 along_W = Vec3::Zero();
    Vec3 axis_W = Vec3::UnitZ();  // axis about which the angles are measured
    bool trained = false;
    RunningMean before;  // compensation in baseline trials and in probes before training [deg]
    RunningMean probes;  // compensation in probes after training began [deg]
};

/// Directions that differ by less than this are the same, whatever the names of their conditions
/// [deg].
constexpr double kSameDirection = 1;

struct Round {
    std::map<std::string, Direction> directions;  // by key_of()
    RunningMean baseline;                         // compensation [deg]
    bool trained = false;                         // whether any trial has been perturbed so far
};

/// Unit vector in the direction of the reach that a trial asks for. `number`: trial number in the
/// session, from 1.
Vec3 direction_of(const std::vector<task::ReachPlan>& reaches, int number) {
    const auto i = static_cast<size_t>(number - 1);
    if (number < 1 || i >= reaches.size()) return Vec3::Constant(kUnmeasured);
    return (reaches[i].to_W - reaches[i].from_W).normalized();
}

Vec3 axis_of(const std::vector<task::ReachPlan>& reaches, int number) {
    const auto i = static_cast<size_t>(number - 1);
    return number < 1 || i >= reaches.size() ? Vec3::Constant(kUnmeasured) : reaches[i].axis_W;
}

/// Returns a key for a condition and direction: a condition may have several directions, if they
/// are drawn.
std::string key_of(const std::string& condition, const Vec3& along_W) {
    return fmt::format("{} {:.2f} {:.2f} {:.2f}", condition, along_W.x(), along_W.y(), along_W.z());
}

std::map<std::string, Round> rounds_of(const rows::TrialFile& trials,
                                       const std::vector<task::ReachPlan>& reaches) {
    std::map<std::string, Round> rounds;
    const std::map<int, int> last = last_attempts(trials);
    for (const rows::TrialRow& row : trials) {
        const rows::TrialKind kind = row.asked.kind;
        Round& round = rounds[row.asked.round];
        const double compensation = -row.measures.hand_angle_deg;
        const Vec3 along_W = direction_of(reaches, row.asked.trial);
        Direction& direction = round.directions[key_of(row.asked.condition, along_W)];
        direction.condition = row.asked.condition;
        direction.along_W = along_W;
        direction.axis_W = axis_of(reaches, row.asked.trial);
        if (kind == rows::TrialKind::perturbed) {
            direction.trained = true;
            round.trained = true;
        }
        if (std::isnan(compensation) || row.measures.attempt < last.at(row.asked.trial)) continue;
        const bool probe = is_clamp(kind) || kind == rows::TrialKind::catch_trial;
        if (probe && round.trained) direction.probes.add(compensation);
        if (kind == rows::TrialKind::baseline || (probe && !round.trained)) {
            round.baseline.add(compensation);
            direction.before.add(compensation);
        }
    }
    return rounds;
}

/// Signed angle between a direction and the nearest trained direction [deg].
double angle_from_trained(const Direction& direction, const Round& round) {
    double nearest = kUnmeasured;
    for (const auto& [name, other] : round.directions) {
        if (!other.trained) continue;
        const double cosine = direction.along_W.dot(other.along_W);
        const double size = std::acos(std::clamp(cosine, -1.0, 1.0));
        if (std::abs(nearest) <= size) continue;
        const bool behind = direction.axis_W.dot(other.along_W.cross(direction.along_W)) < 0;
        nearest = behind ? -size : size;
    }
    return nearest * 180 / std::numbers::pi;
}

/// Returns the mean compensation in the probes minus the baseline of the same direction or, if it
/// has none, the baseline of all directions.
double compensation_of(const Direction& direction, const Round& round) {
    const RunningMean& before = direction.before.count > 0 ? direction.before : round.baseline;
    return direction.probes.value() - (before.count > 0 ? before.value() : 0);
}

const char* baseline_of(const Direction& direction, const Round& round) {
    if (direction.before.count > 0) return "its condition";
    return round.baseline.count > 0 ? "all conditions" : "none";
}

/// Returns the results of a round, sorted by ascending angle. Empty unless the round has probes in
/// untrained directions.
std::vector<Generalisation> generalisation_of(const std::string& name, const Round& round) {
    std::vector<Generalisation> out;
    RunningMean at_trained;
    bool any = false;
    for (const auto& [key, direction] : round.directions) {
        if (direction.probes.count == 0) continue;
        const bool trained = std::abs(angle_from_trained(direction, round)) < kSameDirection;
        if (trained) at_trained.add(compensation_of(direction, round));
        any = any || !trained;
    }
    if (!any || !round.trained) return out;
    for (const auto& [key, direction] : round.directions) {
        if (direction.probes.count == 0) continue;
        const double compensation = compensation_of(direction, round);
        out.push_back({name, direction.condition, angle_from_trained(direction, round),
                       compensation, baseline_of(direction, round),
                       compensation / at_trained.value(), direction.probes.count});
    }
    std::stable_sort(out.begin(), out.end(), [](const Generalisation& a, const Generalisation& b) {
        return a.angle_deg < b.angle_deg;
    });
    return out;
}

}  // namespace

std::vector<Generalisation> find_generalisation(const rows::TrialFile& trials,
                                                const std::vector<task::ReachPlan>& reaches) {
    std::vector<Generalisation> out;
    for (const auto& [name, round] : rounds_of(trials, reaches)) {
        const std::vector<Generalisation> of_round = generalisation_of(name, round);
        out.insert(out.end(), of_round.begin(), of_round.end());
    }
    return out;
}

}  // namespace dihaptic::analysis
