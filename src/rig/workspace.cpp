#include "rig/workspace.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace dihaptic::rig {
namespace {

/// Approximate number of points in the grid. It is fixed, so that the search takes about the same
/// time for any rig.
constexpr double kPoints = 8e6;
constexpr double kFinest = 1e-3;  // smallest spacing of the grid [m]
/// Largest number of cells along an axis. The largest box is sought among cells that are several
/// grid points wide.
constexpr int kMostCells = 64;

/// A hand that does not move, because simulated devices need a hand.
class StillDriver final : public hand::Driver {
  public:
    double duration() const override { return 0; }
    const std::vector<Phase>& phases() const override { return phases_; }

  private:
    hand::FingerTarget do_target(int, double) const noexcept override { return {}; }
    std::vector<Phase> phases_;
};

/// The points of a grid, with a flag for those that are inside.
struct Grid {
    Eigen::Vector3i size;
    std::vector<uint8_t> in;

    explicit Grid(const Eigen::Vector3i& n)
        : size(n),
          in(static_cast<size_t>(n.x()) * static_cast<size_t>(n.y()) * static_cast<size_t>(n.z())) {
    }
    size_t at(int x, int y, int z) const {
        return (static_cast<size_t>(z) * static_cast<size_t>(size.y()) + static_cast<size_t>(y)) *
                   static_cast<size_t>(size.x()) +
               static_cast<size_t>(x);
    }
};

/// The distance transform of one line of squared distances, computed from the lower envelope of
/// parabolas (Felzenszwalb and Huttenlocher 2012). `step` is the number of array elements from one
/// of the line's `n` values to the next.
class DistanceLine {
  public:
    explicit DistanceLine(int most)
        : values_(static_cast<size_t>(most)),
          roots_(static_cast<size_t>(most)),
          ends_(static_cast<size_t>(most) + 1) {}

    void transform(float* line, size_t step, int n) {
        for (int i = 0; i < n; ++i)
            values_[static_cast<size_t>(i)] = line[static_cast<size_t>(i) * step];
        const auto value = [&](int i) {
            return static_cast<double>(values_[static_cast<size_t>(i)]);
        };
        constexpr double kInfinite = std::numeric_limits<double>::infinity();
        size_t k = 0;
        roots_[0] = 0;
        ends_[0] = -kInfinite;
        ends_[1] = kInfinite;
        for (int q = 1; q < n; ++q) {
            const auto meets = [&](int r) {
                return (value(q) - value(r) + static_cast<double>(q) * q -
                        static_cast<double>(r) * r) /
                       (2.0 * (q - r));
            };
            double s = meets(roots_[k]);
            while (s <= ends_[k]) s = meets(roots_[--k]);
            ++k;
            roots_[k] = q;
            ends_[k] = s;
            ends_[k + 1] = kInfinite;
        }
        k = 0;
        for (int q = 0; q < n; ++q) {
            while (ends_[k + 1] < q) ++k;
            const double off = q - roots_[k];
            line[static_cast<size_t>(q) * step] = static_cast<float>(off * off + value(roots_[k]));
        }
    }

  private:
    std::vector<float> values_;
    std::vector<int> roots_;
    std::vector<double> ends_;
};

/// Finds the point that is farthest from all the points outside. All points beyond the grid count
/// as outside.
void find_sphere(const Grid& grid, Workspace& out) {
    const Eigen::Vector3i n = grid.size;
    // adds a margin of points that are outside
    const Grid padded(n + Eigen::Vector3i::Constant(2));
    const Eigen::Vector3i m = padded.size;
    constexpr float kFar = 1e9F;
    std::vector<float> squared(padded.in.size(), 0);
    for (int z = 0; z < n.z(); ++z)
        for (int y = 0; y < n.y(); ++y)
            for (int x = 0; x < n.x(); ++x)
                if (grid.in[grid.at(x, y, z)]) squared[padded.at(x + 1, y + 1, z + 1)] = kFar;
    DistanceLine line(m.maxCoeff());
    for (int z = 0; z < m.z(); ++z)
        for (int y = 0; y < m.y(); ++y) line.transform(&squared[padded.at(0, y, z)], 1, m.x());
    for (int z = 0; z < m.z(); ++z)
        for (int x = 0; x < m.x(); ++x)
            line.transform(&squared[padded.at(x, 0, z)], static_cast<size_t>(m.x()), m.y());
    for (int y = 0; y < m.y(); ++y)
        for (int x = 0; x < m.x(); ++x)
            line.transform(&squared[padded.at(x, y, 0)],
                           static_cast<size_t>(m.x()) * static_cast<size_t>(m.y()), m.z());
    float most = 0;
    for (int z = 1; z <= n.z(); ++z)
        for (int y = 1; y <= n.y(); ++y)
            for (int x = 1; x <= n.x(); ++x) {
                const float here = squared[padded.at(x, y, z)];
                if (here <= most) continue;
                most = here;
                out.sphere_centre = out.first + out.spacing * Vec3(x - 1, y - 1, z - 1);
            }
    // the edge is nearer than the next point outside, but by no more than the diagonal of a cell
    out.sphere_radius =
        std::max(0.0, (std::sqrt(static_cast<double>(most)) - std::sqrt(3.0)) * out.spacing);
}

/// The largest rectangle under a row of heights: its left end, its right end, and its height.
struct Rectangle {
    int left = 0, right = 0, height = 0;
    int area() const { return (right - left) * height; }
};
Rectangle largest_under(const std::vector<int>& heights, std::vector<int>& stack) {
    Rectangle best;
    stack.clear();
    const auto n = static_cast<int>(heights.size());
    for (int i = 0; i <= n; ++i) {
        const int height = i < n ? heights[static_cast<size_t>(i)] : 0;
        while (!stack.empty() && heights[static_cast<size_t>(stack.back())] >= height) {
            const int top = heights[static_cast<size_t>(stack.back())];
            stack.pop_back();
            const Rectangle here{stack.empty() ? 0 : stack.back() + 1, i, top};
            if (here.area() > best.area()) best = here;
        }
        stack.push_back(i);
    }
    return best;
}

/// Returns the cells whose sides are `side` steps long and whose points are all inside.
/// Neighbouring cells share the points on their common face.
Grid full_cells(const Grid& grid, int side) {
    Grid cells(((grid.size - Eigen::Vector3i::Ones()) / side).cwiseMax(0));
    const Eigen::Vector3i n = cells.size;
    for (int z = 0; z < n.z(); ++z)
        for (int y = 0; y < n.y(); ++y)
            for (int x = 0; x < n.x(); ++x) {
                bool all = true;
                for (int k = 0; k <= side && all; ++k)
                    for (int j = 0; j <= side && all; ++j)
                        for (int i = 0; i <= side && all; ++i)
                            all = grid.in[grid.at(x * side + i, y * side + j, z * side + k)] != 0;
                cells.in[cells.at(x, y, z)] = all;
            }
    return cells;
}

/// Finds the largest box of full cells. To do so, it finds for every stack of layers the largest
/// rectangle of columns that are full in all these layers.
void find_box(const Grid& grid, Workspace& out) {
    const int side = std::max(1, (grid.size.maxCoeff() - 2) / kMostCells + 1);
    const Grid cells = full_cells(grid, side);
    const Eigen::Vector3i n = cells.size;
    int best = 0;
    std::vector<int> heights(static_cast<size_t>(n.x()));
    std::vector<int> stack;
    for (int low = 0; low < n.z(); ++low) {
        std::vector<uint8_t> through(static_cast<size_t>(n.x()) * static_cast<size_t>(n.y()), 1);
        for (int high = low + 1; high <= n.z(); ++high) {
            std::fill(heights.begin(), heights.end(), 0);
            for (int y = 0; y < n.y(); ++y) {
                for (int x = 0; x < n.x(); ++x) {
                    uint8_t& column = through[static_cast<size_t>(y * n.x() + x)];
                    column = column & cells.in[cells.at(x, y, high - 1)];
                    int& height = heights[static_cast<size_t>(x)];
                    height = column ? height + 1 : 0;
                }
                const Rectangle here = largest_under(heights, stack);
                if (here.area() * (high - low) <= best) continue;
                best = here.area() * (high - low);
                const double cell = side * out.spacing;
                out.box = {out.first + cell * Vec3(here.left, y + 1 - here.height, low),
                           out.first + cell * Vec3(here.right, y + 1, high)};
            }
        }
    }
}

}  // namespace

Reach::Reach(const Device& device, const frame::DeviceInfo& info)
    : finger_(device.finger), X_DW_(device.X_WD().inverse()), scale_(info.scale), arm_(info.arm) {
    if (arm_) {
        // a cube around the shoulder that contains the arm in any direction
        const double length = scale_ * (arm_->thigh + arm_->shin);
        const Vec3 shoulder = device.X_WD() * (scale_ * Vec3(0, arm_->shin, -arm_->thigh));
        bounds_ = {shoulder - Vec3::Constant(length), shoulder + Vec3::Constant(length)};
        return;
    }
    if (!info.workspace) {
        throw Error(device.place, "options",
                    fmt::format("the {}'s device does not state its reach", finger_),
                    "Give workspace_mm, the edges of the box that it reaches.");
    }
    half_ = *info.workspace / 2;
    for (int corner = 0; corner < 8; ++corner) {
        const Vec3 sides(corner & 1 ? 1 : -1, corner & 2 ? 1 : -1, corner & 4 ? 1 : -1);
        bounds_.extend(device.X_WD() * half_.cwiseProduct(sides));
    }
}

bool Reach::contains(const Vec3& p_WH) const {
    const Vec3 p_DH = X_DW_ * p_WH;
    if (arm_) return model::phantom_reaches(*arm_, p_DH / scale_);
    return (p_DH.array().abs() <= half_.array()).all();
}

std::vector<Reach> reaches(const Rig& rig) {
    const std::vector<std::string> fingers = held_fingers(rig);
    const StillDriver still;
    devices::Context context;
    context.driver = &still;
    std::vector<frame::DeviceInfo> infos = describe(rig, fingers, context);
    const auto knows = [](const frame::DeviceInfo& info) { return info.arm || info.workspace; };
    if (!std::all_of(infos.begin(), infos.end(), knows))
        infos = make_devices(rig, fingers, context)->descriptions();
    std::vector<Reach> out;
    for (size_t i = 0; i < fingers.size(); ++i) out.emplace_back(rig.devices[i], infos[i]);
    return out;
}

Placement propose_placement(const Workspace& workspace) {
    Placement out;
    out.wall.centre = workspace.box.center();
    out.wall.size = workspace.box.sizes();
    out.origin = out.wall.centre;
    out.origin.z() = workspace.box.min().z() + kUnderTable;
    return out;
}

double out_of_reach(const Eigen::AlignedBox3d& box, const std::vector<Reach>& reaches) {
    constexpr int kSide = 40;  // number of points along a side, including the corners
    int out = 0;
    for (int i = 0; i < kSide * kSide * kSide; ++i) {
        const Vec3 share = Vec3(i % kSide, i / kSide % kSide, i / (kSide * kSide)) / (kSide - 1);
        const Vec3 p_W = box.min() + share.cwiseProduct(box.sizes());
        if (!std::all_of(reaches.begin(), reaches.end(),
                         [&](const Reach& reach) { return reach.contains(p_W); }))
            ++out;
    }
    return static_cast<double>(out) / (kSide * kSide * kSide);
}

Workspace find_workspace(const std::vector<Reach>& reaches,
                         const std::function<void(double share)>& progress) {
    Eigen::AlignedBox3d all;
    for (const Reach& reach : reaches) all.extend(reach.bounds());
    Workspace out;
    out.spacing = std::max(kFinest, std::cbrt(all.volume() / kPoints));
    out.size = (all.sizes() / out.spacing).array().floor().cast<int>() + 1;
    // centres the grid in the box
    out.first = all.center() - out.spacing / 2 * (out.size.cast<double>() - Vec3::Ones());
    const size_t columns = static_cast<size_t>(out.size.x()) * static_cast<size_t>(out.size.y());
    out.volumes.resize(reaches.size());
    out.shadows.assign(reaches.size(), {std::vector<uint8_t>(columns)});
    out.shared_shadow.held.resize(columns);

    Grid shared(out.size);
    const double cell = out.spacing * out.spacing * out.spacing;
    std::vector<int64_t> counts(reaches.size());
    int64_t count = 0;
    for (int z = 0; z < out.size.z(); ++z) {
        // the search that follows takes about a tenth of the total time
        progress(0.9 * z / out.size.z());
        for (int y = 0; y < out.size.y(); ++y) {
            for (int x = 0; x < out.size.x(); ++x) {
                const Vec3 p_WH = out.first + out.spacing * Vec3(x, y, z);
                const size_t column = shared.at(x, y, 0);
                bool by_all = true;
                for (size_t i = 0; i < reaches.size(); ++i) {
                    const bool in = reaches[i].bounds().contains(p_WH) && reaches[i].contains(p_WH);
                    by_all = by_all && in;
                    if (!in) continue;
                    ++counts[i];
                    out.shadows[i].held[column] = 1;
                }
                if (!by_all) continue;
                ++count;
                shared.in[shared.at(x, y, z)] = 1;
                out.shared_shadow.held[column] = 1;
            }
        }
    }
    for (size_t i = 0; i < reaches.size(); ++i)
        out.volumes[i] = static_cast<double>(counts[i]) * cell;
    out.shared = static_cast<double>(count) * cell;
    if (count > 0) {
        find_sphere(shared, out);
        progress(0.95);
        find_box(shared, out);
    }
    progress(1);
    return out;
}

}  // namespace dihaptic::rig
