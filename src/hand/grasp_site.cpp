#include "hand/grasp_site.h"

#include <algorithm>

namespace dihaptic::hand {
namespace {

constexpr size_t kStretch = 300;          // number of samples, 1 ms apart
constexpr double kFarShare = 0.93;        // fraction of the largest distance from the start
constexpr double kBridgedPenalty = 0.02;  // movement assumed in a stretch that was not measured [m]
constexpr double kOpening = 0.01;  // distance by which the fingers must close before the grasp [m]

GraspSite site_at(const Path& path, size_t first) {
    const std::vector<Vec3>& thumb = path.p_WH[0];
    const std::vector<Vec3>& index = path.p_WH[1];
    GraspSite site;
    const size_t last = std::min(first + kStretch, path.size());
    Vec3 t = Vec3::Zero();
    Vec3 i = Vec3::Zero();
    for (size_t s = first; s < last; ++s) {
        t += thumb[s];
        i += index[s];
    }
    const auto count = static_cast<double>(last - first);
    t /= count;
    i /= count;
    site.start = static_cast<double>(first) / Path::kRate;
    site.end = static_cast<double>(last) / Path::kRate;
    site.centre = (t + i) / 2;
    site.aperture = (i - t).norm();
    site.axis = (i - t).normalized();
    for (size_t s = 0; s < first; ++s)
        site.peak_aperture = std::max(site.peak_aperture, (index[s] - thumb[s]).norm());
    return site;
}

}  // namespace

std::optional<GraspSite> find_grasp(const Path& path, std::optional<double> at) {
    if (path.p_WH.size() < 2 || path.size() <= kStretch) return std::nullopt;
    if (at) {
        const double first = std::clamp((*at) * Path::kRate - kStretch / 2.0, 0.0,
                                        static_cast<double>(path.size() - kStretch));
        return site_at(path, static_cast<size_t>(first));
    }
    const std::vector<Vec3>& thumb = path.p_WH[0];
    const std::vector<Vec3>& index = path.p_WH[1];
    const size_t n = path.size();
    const Vec3 home = (thumb[0] + index[0]) / 2;
    // use running sums and maxima, so that the cost of a stretch does not depend on its length
    std::vector<double> distance(n), moved(n, 0), unseen(n, 0), opened(n, 0);
    double furthest = 0;
    for (size_t s = 0; s < n; ++s) {
        distance[s] = ((thumb[s] + index[s]) / 2 - home).norm();
        furthest = std::max(furthest, distance[s]);
        opened[s] = (index[s] - thumb[s]).norm();
        if (s == 0) continue;
        opened[s] = std::max(opened[s], opened[s - 1]);
        moved[s] =
            moved[s - 1] + (thumb[s] - thumb[s - 1]).norm() + (index[s] - index[s - 1]).norm();
        unseen[s] = unseen[s - 1] + path.bridged[s];
    }
    std::optional<size_t> best;
    double least = 0;
    for (size_t s = 0; s + kStretch < n; ++s) {
        const size_t e = s + kStretch;
        const bool far = std::min(distance[s], distance[e]) >= kFarShare * furthest;
        const bool closed = opened[s] - (index[s] - thumb[s]).norm() >= kOpening;
        if (!far || !closed) continue;
        const double cost =
            moved[e] - moved[s] + kBridgedPenalty * (unseen[e] - unseen[s]) / kStretch;
        if (!best || cost < least) {
            best = s;
            least = cost;
        }
    }
    if (!best) return std::nullopt;
    return site_at(path, *best);
}

}  // namespace dihaptic::hand
