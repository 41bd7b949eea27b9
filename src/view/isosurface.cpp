#include "view/isosurface.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

namespace dihaptic::view {
namespace {

Vec3 gradient(const Field& field, const Vec3& p) {
    constexpr double kStep = 2e-4;  // [m]
    Vec3 out;
    for (int k = 0; k < 3; ++k) {
        const Vec3 step = kStep * Vec3::Unit(k);
        out[k] = (field(p + step) - field(p - step)) / (2 * kStep);
    }
    return out;
}

/// The field at the corners of a regular grid.
class Grid {
  public:
    using Corner = std::array<int, 3>;

    Grid(const Field& field, const Vec3& low, const Vec3& high, double cell)
        : low_(low), cell_(cell) {
        for (size_t k = 0; k < 3; ++k) {
            const auto axis = static_cast<Eigen::Index>(k);
            size_[k] = static_cast<int>(std::ceil((high[axis] - low[axis]) / cell)) + 1;
        }
        values_.reserve(count());
        for_each([&](const Corner& at) { values_.push_back(field(place(at))); });
    }

    size_t count() const {
        return static_cast<size_t>(size_[0]) * static_cast<size_t>(size_[1]) *
               static_cast<size_t>(size_[2]);
    }
    size_t index(const Corner& at) const {
        return static_cast<size_t>((at[2] * size_[1] + at[1]) * size_[0] + at[0]);
    }
    Vec3 place(const Corner& at) const { return low_ + cell_ * Vec3(at[0], at[1], at[2]); }
    double value(const Corner& at) const { return values_[index(at)]; }
    bool inside(const Corner& at) const { return value(at) < 0; }
    bool has(const Corner& at) const {
        return at[0] < size_[0] && at[1] < size_[1] && at[2] < size_[2];
    }

    /// Calls visit(corner) for each corner, in the order of their indices.
    template <class Visit>
    void for_each(Visit&& visit) const {
        for (int z = 0; z < size_[2]; ++z)
            for (int y = 0; y < size_[1]; ++y)
                for (int x = 0; x < size_[0]; ++x) visit(Corner{x, y, z});
    }

  private:
    Vec3 low_;
    double cell_;
    Corner size_{};
    std::vector<double> values_;
};

Grid::Corner next(Grid::Corner at, size_t axis, int steps = 1) {
    at[axis] += steps;
    return at;
}

/// The mean of the points where the surface crosses the edges of the cell above `at`; nullopt if it
/// crosses none.
std::optional<Vec3> middle(const Grid& grid, const Grid::Corner& at) {
    Vec3 sum = Vec3::Zero();
    int crossings = 0;
    for (int corner = 0; corner < 8; ++corner) {
        const Grid::Corner from{at[0] + (corner & 1), at[1] + (corner >> 1 & 1),
                                at[2] + (corner >> 2)};
        for (size_t axis = 0; axis < 3; ++axis) {
            if ((corner >> axis & 1) != 0) continue;
            const Grid::Corner to = next(from, axis);
            if (grid.inside(from) == grid.inside(to)) continue;
            const double share = grid.value(from) / (grid.value(from) - grid.value(to));
            sum += grid.place(from) + share * (grid.place(to) - grid.place(from));
            ++crossings;
        }
    }
    if (crossings == 0) return std::nullopt;
    return sum / crossings;
}

}  // namespace

Triangles isosurface(const Field& field, const Vec3& low, const Vec3& high, double cell) {
    const Grid grid(field, low, high, cell);
    Triangles out;
    std::vector<uint32_t> vertex_of(grid.count());  // by the lowest corner of the cell
    grid.for_each([&](const Grid::Corner& at) {
        if (!grid.has({at[0] + 1, at[1] + 1, at[2] + 1})) return;
        auto p = middle(grid, at);
        if (!p) return;
        Vec3 slope = gradient(field, *p);
        *p -= field(*p) / std::max(slope.squaredNorm(), 0.1) * slope;
        slope = gradient(field, *p);
        vertex_of[grid.index(at)] = static_cast<uint32_t>(out.vertices.size());
        out.vertices.push_back({p->cast<float>(), slope.normalized().cast<float>()});
    });
    // each edge that the surface crosses is surrounded by four cells
    grid.for_each([&](const Grid::Corner& at) {
        for (size_t axis = 0; axis < 3; ++axis) {
            const size_t side = (axis + 1) % 3, up = (axis + 2) % 3;
            const Grid::Corner to = next(at, axis);
            if (!grid.has(to) || grid.inside(at) == grid.inside(to)) continue;
            const auto of = [&](int sideways, int upward) {
                return vertex_of[grid.index(next(next(at, side, -sideways), up, -upward))];
            };
            std::array<uint32_t, 4> quad{of(1, 1), of(0, 1), of(0, 0), of(1, 0)};
            if (!grid.inside(at)) std::swap(quad[1], quad[3]);
            for (const size_t corner : {0, 1, 2, 0, 2, 3}) out.indices.push_back(quad[corner]);
        }
    });
    return out;
}

}  // namespace dihaptic::view
