// Lemke's method for the linear complementarity problem  w = M z + q,  z >= 0, w >= 0, z'w = 0
// (Cottle, Pang and Stone 1992, section 4.4), with a lexicographic ratio test, so that degenerate
// problems do not cycle.
#pragma once

#include <Eigen/Dense>
#include <cstdint>
#include <limits>
#include <memory>
#include <vector>

namespace dihaptic::contact {

class Lemke {
  public:
    /// Reserves memory for problems with up to this many variables, without touching the memory:
    /// the system provides pages when a problem first needs them, which never happens in most
    /// programs. The page faults of the first use take too little time, compared with the pivots,
    /// to be measurable.
    void reserve(int variables);
    int capacity() const noexcept { return capacity_; }

    /// Starts a problem with this many variables. The caller then fills in M and q.
    void start(int variables) noexcept;
    double& M(int row, int column) noexcept {
        return M_[static_cast<size_t>(row) * static_cast<size_t>(n_) + static_cast<size_t>(column)];
    }
    double& q(int row) noexcept { return q_[static_cast<size_t>(row)]; }
    double z(int i) const noexcept { return z_[static_cast<size_t>(i)]; }
    double w(int i) const noexcept { return w_[static_cast<size_t>(i)]; }

    /// Pivots along covering vector number `attempt`: number 0 consists of ones, and the others are
    /// scattered about it. Does not allocate. Returns false if no solution is found within the
    /// method's own limit of pivots, or within `most_pivots`.
    bool solve(int attempt, int64_t most_pivots = std::numeric_limits<int64_t>::max()) noexcept;
    /// Tries, with the current M and q, the set of variables that were positive in the last
    /// solution. Returns false if this does not solve the problem.
    bool try_last_basis() noexcept;
    bool solve_last_basis(int m) noexcept;

    int pivots() const noexcept { return pivots_; }
    /// Number of tableau entries changed by one pivot, and by one call of try_last_basis().
    int64_t pivot_entries() const noexcept { return int64_t{n_} * (2 * n_ + 2); }
    int64_t basis_entries() const noexcept {
        const auto m = static_cast<int64_t>(last_basis_.size());
        return m * m * m / 2 + int64_t{n_} * n_;
    }

  private:
    using Matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

    double* row(int i) noexcept { return &tableau_[static_cast<size_t>(i) * stride_]; }
    int leaving_row(int entering) noexcept;
    void pivot(int leaving, int entering) noexcept;
    void read_solution() noexcept;
    bool lexicographically_less(int i, double by_i, int j, double by_j) noexcept;

    int capacity_ = 0;
    int n_ = 0;
    size_t stride_ = 0;  // length of a row: w, z, z0, and the right-hand side
    int pivots_ = 0;
    std::unique_ptr<double[]> M_;
    std::unique_ptr<double[]> tableau_;  // also used by try_last_basis() as scratch memory
    std::vector<double> q_, z_, w_;
    std::vector<int> basis_;       // for each row: the column that is basic
    std::vector<int> last_basis_;  // the basic z variables of the last solution
    std::vector<double> right_;
};

}  // namespace dihaptic::contact
