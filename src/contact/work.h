// Work counts the work done by the solves of a tick and determines how much is still allowed. No
// clock is read, so a replay gives bit-identical results.
//
// The unit is a visit: the work that a projected Gauss-Seidel sweep does on one contact. Everything
// else is counted as the number of visits that take the same time (README.md has a table, and the
// duration of a visit).
#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>

namespace dihaptic::contact {

/// Costs in visits, per contact:
struct Visits {
    static constexpr int64_t assembly = 6;
    static constexpr int64_t velocity = 1;
    static constexpr int64_t matrix = 4;        ///< setting up the matrix for Newton's method
    static constexpr int64_t acceleration = 4;  ///< for a step of Anderson's method
    /// Cost of multiplying two 6 x 6 blocks; factorisations are counted in such products.
    static constexpr int64_t product = 2;
    /// Number of entries of a dense matrix that can be changed in the time of a visit.
    static constexpr int64_t entries = 30;
};

class Work {
  public:
    static constexpr int64_t kEndless = std::numeric_limits<int64_t>::max() / 4;

    /// The fraction 1 / kForSweeps of the work is reserved for sweeps, which finish the answers of
    /// exact methods.
    explicit Work(int64_t most = kEndless) noexcept : most_(most) { share(1); }

    /// Allows the solves that follow one of `parts` equal parts of the remaining work.
    void share(int64_t parts) noexcept {
        const int64_t part = std::max<int64_t>(0, most_ - spent_) / std::max<int64_t>(1, parts);
        exact_ = limit_ = spent_ + part - part / kForSweeps;
        end_ = spent_ + part;
    }
    /// From here on, the work is done by exact methods.
    void begin_exact() noexcept { limit_ = exact_; }
    /// Like begin_exact(), but half of what is left of that work is reserved for another method.
    void begin_half() noexcept { limit_ = spent_ + (exact_ - spent_) / 2; }
    /// From here on, the work is done by sweeps, which are allowed at least this many visits.
    void begin_sweeps(int64_t least) noexcept { limit_ = std::max(end_, spent_ + least); }

    void spend(int64_t visits) noexcept { spent_ += visits; }
    int64_t spent() const noexcept { return spent_; }
    bool affords(int64_t visits) const noexcept { return spent_ + visits <= limit_; }
    /// Returns how many times the given number of visits is still allowed.
    int64_t times(int64_t visits) const noexcept {
        return std::max<int64_t>(0, limit_ - spent_) / std::max<int64_t>(1, visits);
    }

  private:
    static constexpr int64_t kForSweeps = 5;  // one part in this many is reserved

    int64_t most_;
    int64_t spent_ = 0;
    int64_t exact_ = 0;
    int64_t end_ = 0;
    int64_t limit_ = 0;
};

}  // namespace dihaptic::contact
