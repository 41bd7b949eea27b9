// Lemke's method for the linear complementarity problem  w = M z + q,  z >= 0, w >= 0, z'w = 0
// (Cottle, Pang and Stone 1992, section 4.4), with lexicographic ratio test, so that degenerate
// problems do not cycle.
#pragma once

#include <Eigen/Dense>
#include <memory>
#include <vector>

namespace dihaptic::contact {

class Lemke {
  public:
    /// Memory for problems up to so many variables. It is not touched: the system gives pages when
    /// problems first need them, and most programs never do. Beside the pivots, page faults of the
    /// first use are too few to measure.
    void reserve(int variables);
    int capacity() const noexcept { return capacity_; }

    /// The problem to fill in: M and q of so many variables.
    void start(int variables) noexcept;
    double& M(int row, int column) noexcept {
        return M_[static_cast<size_t>(row) * static_cast<size_t>(n_) + static_cast<size_t>(column)];
    }
    double& q(int row) noexcept { return q_[static_cast<size_t>(row)]; }
    double z(int i) const noexcept { return z_[static_cast<size_t>(i)]; }
    double w(int i) const noexcept { return w_[static_cast<size_t>(i)]; }

    /// Pivots along the covering vector number `attempt`: 0 is all ones, others are scattered about
    /// it. Allocates nothing. False: no solution within the most pivots.
    bool solve(int attempt) noexcept;
    /// Tries the set of variables that were positive in the last solution, whatever M and q are
    /// now. False: it is none of this problem.
    bool try_last_basis() noexcept;
    bool solve_last_basis(int m) noexcept;

    int pivots() const noexcept { return pivots_; }

  private:
    using Matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

    double* row(int i) noexcept { return &tableau_[static_cast<size_t>(i) * stride_]; }
    int leaving_row(int entering) noexcept;
    void pivot(int leaving, int entering) noexcept;
    void read_solution() noexcept;
    bool lexicographically_less(int i, double by_i, int j, double by_j) noexcept;

    int capacity_ = 0;
    int n_ = 0;
    size_t stride_ = 0;  // w, z, z0, right side
    int pivots_ = 0;
    std::unique_ptr<double[]> M_;
    std::unique_ptr<double[]> tableau_;  // try_last_basis has its own use for it
    std::vector<double> q_, z_, w_;
    std::vector<int> basis_;       // by row: which column is basic
    std::vector<int> last_basis_;  // z that were basic in the last solution
    std::vector<double> right_;
};

}  // namespace dihaptic::contact
