// Work counts the work of a tick's solves and gives their remaining allowance. No clock is read,
// so a replay repeats it to the bit.
//
// The unit is a visit: the work of a projected Gauss-Seidel sweep on one contact. Everything else
// is counted as the number of visits that take the same time (README.md has the table, and the time
// of a visit).
#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>

namespace dihaptic::contact {

/// Costs in visits, for each contact:
struct Visits {
    static constexpr int64_t assembly = 6;
    static constexpr int64_t velocity = 1;
    static constexpr int64_t matrix = 4;        ///< for Newton's method
    static constexpr int64_t acceleration = 4;  ///< a step of Anderson's method
    /// Cost of a product of two 6 x 6 blocks; a factorisation is counted in such products.
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

    /// Allows the following solves one of `parts` equal parts of the remaining work.
    void share(int64_t parts) noexcept {
        const int64_t part = std::max<int64_t>(0, most_ - spent_) / std::max<int64_t>(1, parts);
        exact_ = limit_ = spent_ + part - part / kForSweeps;
        end_ = spent_ + part;
    }
    /// From here on, work is done by exact methods.
    void begin_exact() noexcept { limit_ = exact_; }
    /// From here on, work is done by sweeps, which are allowed at least this many visits.
    void begin_sweeps(int64_t least) noexcept { limit_ = std::max(end_, spent_ + least); }

    void spend(int64_t visits) noexcept { spent_ += visits; }
    int64_t spent() const noexcept { return spent_; }
    bool affords(int64_t visits) const noexcept { return spent_ + visits <= limit_; }
    /// How many times the given number of visits is still allowed.
    int64_t times(int64_t visits) const noexcept {
        return std::max<int64_t>(0, limit_ - spent_) / std::max<int64_t>(1, visits);
    }

  private:
    static constexpr int64_t kForSweeps = 5;  // one part in this many

    int64_t most_;
    int64_t spent_ = 0;
    int64_t exact_ = 0;
    int64_t end_ = 0;
    int64_t limit_ = 0;
};

}  // namespace dihaptic::contact
