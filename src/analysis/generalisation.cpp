#include "analysis/generalisation.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <set>

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

/// A condition in a round.
struct Direction {
    Vec3 along_W = Vec3::Zero();
    bool trained = false;
    Mean probes;  // compensation [deg]
};

/// Unit vector of the reach that a trial asks for; `number`: in the session, from 1.
Vec3 direction_of(const CsvFile& list, int number) {
    const auto i = static_cast<size_t>(number - 1);
    if (number < 1 || i >= list.rows()) return Vec3::Constant(kUnmeasured);
    Vec3 way;
    for (int k = 0; k < 3; ++k) {
        const std::string axis(1, "xyz"[k]);
        way[k] = list.number(i, "reach_to_" + axis + "_mm") -
                 list.number(i, "reach_from_" + axis + "_mm");
    }
    return way.normalized();
}

}  // namespace

std::vector<Generalisation> find_generalisation(const CsvFile& trials, const CsvFile& list) {
    std::map<std::string, std::map<std::string, Direction>> rounds;
    std::map<std::string, Mean> baseline;
    std::set<std::string> trained;  // rounds in which something was perturbed by now
    for (size_t i = 0; i < trials.rows(); ++i) {
        const std::string round = trials.text(i, "round");
        const std::string kind = trials.text(i, "kind");
        const double compensation = -trials.number(i, "hand_angle_deg");
        Direction& direction = rounds[round][trials.text(i, "condition")];
        direction.along_W = direction_of(list, static_cast<int>(trials.number(i, "trial_num")));
        if (kind == "perturbed") {
            direction.trained = true;
            trained.insert(round);
        }
        if (std::isnan(compensation)) continue;
        if (kind == "baseline") baseline[round].add(compensation);
        const bool probe = kind == "error_clamp" || kind == "catch";
        if (probe && trained.count(round) > 0) direction.probes.add(compensation);
    }

    std::vector<Generalisation> out;
    for (const auto& [round, directions] : rounds) {
        const double bias = baseline[round].count == 0 ? 0 : baseline[round].value();
        Mean at_trained;
        bool any = false;
        for (const auto& [condition, direction] : directions) {
            if (direction.trained && direction.probes.count > 0)
                at_trained.add(direction.probes.value() - bias);
            any = any || (!direction.trained && direction.probes.count > 0);
        }
        if (!any || trained.count(round) == 0) continue;
        const size_t first = out.size();
        for (const auto& [condition, direction] : directions) {
            if (direction.probes.count == 0) continue;
            double nearest = kUnmeasured;
            for (const auto& [name, other] : directions) {
                if (!other.trained) continue;
                const double cosine = direction.along_W.dot(other.along_W);
                nearest = std::fmin(nearest, std::acos(std::clamp(cosine, -1.0, 1.0)));
            }
            const double compensation = direction.probes.value() - bias;
            out.push_back({round, condition, nearest * 180 / std::numbers::pi, compensation,
                           compensation / at_trained.value(), direction.probes.count});
        }
        std::stable_sort(
            out.begin() + static_cast<std::ptrdiff_t>(first), out.end(),
            [](const Generalisation& a, const Generalisation& b) { return a.angle < b.angle; });
    }
    return out;
}

}  // namespace dihaptic::analysis
