// Anderson acceleration of a fixed-point iteration x = g(x) (Walker and Ni 2011): the next x is the
// combination of the last few points that has the smallest linearised residual g(x) - x.
#pragma once

#include <Eigen/Dense>
#include <array>
#include <vector>

namespace dihaptic::contact {

class Anderson {
  public:
    static constexpr int kDepth = 10;
    /// A difference column is left out if at most this fraction of it lies outside the span of the
    /// newer columns.
    static constexpr double kNothingNew = 1e-8;

    void reserve(size_t size) {
        for (auto& column : dx_) column.reserve(size);
        for (auto& column : df_) column.reserve(size);
        for (auto& column : basis_) column.reserve(size);
        x_.reserve(size);
        f_.reserve(size);
    }
    void start(size_t size) noexcept {
        for (auto& column : dx_) column.resize(size);
        for (auto& column : df_) column.resize(size);
        for (auto& column : basis_) column.resize(size);
        x_.resize(size);
        f_.resize(size);
        forget();
    }
    /// Forgets the stored points. To be called when they are no longer useful.
    void forget() noexcept {
        count_ = 0;
        next_ = 0;
        has_last_ = false;
    }

    /// Replaces x with the next point; g is the image of x, i.e. g(x).
    void advance(std::vector<double>& x, const std::vector<double>& g) noexcept {
        const size_t n = x.size();
        if (has_last_) {
            for (size_t i = 0; i < n; ++i) {
                dx_[next_][i] = x[i] - x_[i];
                df_[next_][i] = (g[i] - x[i]) - f_[i];
            }
            next_ = (next_ + 1) % kDepth;
            count_ = std::min(count_ + 1, static_cast<size_t>(kDepth));
        }
        for (size_t i = 0; i < n; ++i) {
            x_[i] = x[i];
            f_[i] = g[i] - x[i];
            x[i] = g[i];
        }
        has_last_ = true;

        // solve f = sum gamma_k df_k (least squares) by modified Gram-Schmidt, newest column first
        std::array<std::array<double, kDepth>, kDepth> R{};
        std::array<double, kDepth> gamma{};
        std::array<size_t, kDepth> used{};
        size_t rank = 0;
        for (size_t age = 0; age < count_; ++age) {
            const size_t k = (next_ + kDepth - 1 - age) % kDepth;
            std::vector<double>& e = basis_[rank];
            e.assign(df_[k].begin(), df_[k].end());
            const double before = norm(e);
            for (size_t m = 0; m < rank; ++m) {
                R[m][rank] = dot(basis_[m], e);
                for (size_t i = 0; i < n; ++i) e[i] -= R[m][rank] * basis_[m][i];
            }
            const double after = norm(e);
            if (after <= kNothingNew * before) continue;
            for (double& value : e) value /= after;
            R[rank][rank] = after;
            gamma[rank] = dot(e, f_);
            used[rank++] = k;
        }
        for (size_t m = rank; m-- > 0;) {
            for (size_t l = m + 1; l < rank; ++l) gamma[m] -= R[m][l] * gamma[l];
            gamma[m] /= R[m][m];
        }
        for (size_t m = 0; m < rank; ++m) {
            for (size_t i = 0; i < n; ++i) x[i] -= gamma[m] * (dx_[used[m]][i] + df_[used[m]][i]);
        }
    }

  private:
    static double dot(const std::vector<double>& a, const std::vector<double>& b) noexcept {
        double sum = 0;
        for (size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
        return sum;
    }
    static double norm(const std::vector<double>& a) noexcept { return std::sqrt(dot(a, a)); }

    std::array<std::vector<double>, kDepth> dx_;
    std::array<std::vector<double>, kDepth> df_;
    std::array<std::vector<double>, kDepth> basis_;
    std::vector<double> x_;
    std::vector<double> f_;
    size_t count_ = 0;
    size_t next_ = 0;
    bool has_last_ = false;
};

}  // namespace dihaptic::contact
