#include "analysis/generalisation.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>

#include "base/geometry.h"
#include "base/unmeasured.h"

namespace dihaptic::analysis {
namespace {

struct Mean {
    double sum = 0;
    int count = 0;
    void add(double x) {
        sum += x;
        ++count;
    }
    double value() const { return count == 0 ? kUnmeasured : sum / count; }
};

/// The reaches of one condition in a round.
struct Direction {
    Vec3 along_W = Vec3::Zero();
    bool trained = false;
    Mean probes;  // compensation [deg]
};

struct Round {
    std::map<std::string, Direction> directions;  // by condition
    Mean baseline;                                // compensation [deg]
    bool trained = false;                         // whether a trial was perturbed so far
};

/// Unit vector of the reach that a trial demands; `number`: number of the trial in the session,
/// from 1.
Vec3 direction_of(const std::vector<task::ReachPlan>& reaches, int number) {
    const auto i = static_cast<size_t>(number - 1);
    if (number < 1 || i >= reaches.size()) return Vec3::Constant(kUnmeasured);
    return (reaches[i].to_W - reaches[i].from_W).normalized();
}

std::map<std::string, Round> rounds_of(const rows::TrialFile& trials,
                                       const std::vector<task::ReachPlan>& reaches) {
    std::map<std::string, Round> rounds;
    for (const rows::TrialRow& row : trials) {
        const rows::TrialKind kind = row.asked.kind;
        Round& round = rounds[row.asked.round];
        const double compensation = -row.measures.hand_angle_deg;
        Direction& direction = round.directions[row.asked.condition];
        direction.along_W = direction_of(reaches, row.asked.trial);
        if (kind == rows::TrialKind::perturbed) {
            direction.trained = true;
            round.trained = true;
        }
        if (std::isnan(compensation)) continue;
        if (kind == rows::TrialKind::baseline) round.baseline.add(compensation);
        const bool probe = is_clamp(kind) || kind == rows::TrialKind::catch_trial;
        if (probe && round.trained) direction.probes.add(compensation);
    }
    return rounds;
}

/// Angle from the nearest trained direction [deg].
double angle_from_trained(const Direction& direction, const Round& round) {
    double nearest = kUnmeasured;
    for (const auto& [name, other] : round.directions) {
        if (!other.trained) continue;
        const double cosine = direction.along_W.dot(other.along_W);
        nearest = std::fmin(nearest, std::acos(std::clamp(cosine, -1.0, 1.0)));
    }
    return nearest * 180 / std::numbers::pi;
}

/// Results of a round, by rising angle; empty unless it has probes in untrained directions.
std::vector<Generalisation> generalisation_of(const std::string& name, const Round& round) {
    std::vector<Generalisation> out;
    const double bias = round.baseline.count == 0 ? 0 : round.baseline.value();
    Mean at_trained;
    bool any = false;
    for (const auto& [condition, direction] : round.directions) {
        if (direction.trained && direction.probes.count > 0)
            at_trained.add(direction.probes.value() - bias);
        any = any || (!direction.trained && direction.probes.count > 0);
    }
    if (!any || !round.trained) return out;
    for (const auto& [condition, direction] : round.directions) {
        if (direction.probes.count == 0) continue;
        const double compensation = direction.probes.value() - bias;
        out.push_back({name, condition, angle_from_trained(direction, round), compensation,
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
