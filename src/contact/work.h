// Work counts what the solves of a tick do, and says how much more of it they may do. No clock is
// read: a replay repeats it to the bit.
//
// The unit is a visit, what a projected Gauss-Seidel sweep does to one contact. All else is counted
// in as many visits as take as long (README.md has the table, and the time that a visit takes).
#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>

namespace dihaptic::contact {

/// What costs as much as so many visits, for each contact:
struct Visits {
    static constexpr int64_t assembly = 6;
    static constexpr int64_t velocity = 1;
    static constexpr int64_t matrix = 4;        ///< of Newton's method
    static constexpr int64_t acceleration = 4;  ///< a step of Anderson's method
    /// For each product of two 6 x 6 blocks, as which all of a factorisation is counted.
    static constexpr int64_t product = 2;
    /// Entries of a dense matrix that are changed in the time of a visit.
    static constexpr int64_t entries = 30;
};

class Work {
  public:
    static constexpr int64_t kEndless = std::numeric_limits<int64_t>::max() / 4;

    /// A share of what may be done is left to the sweeps that end what exact methods left undone.
    explicit Work(int64_t most = kEndless) noexcept : most_(most) { share(1); }

    /// Allows the solves that follow one in so many parts of what is left.
    void share(int64_t parts) noexcept {
        const int64_t part = std::max<int64_t>(0, most_ - spent_) / std::max<int64_t>(1, parts);
        exact_ = limit_ = spent_ + part - part / kForSweeps;
        end_ = spent_ + part;
    }
    /// From here on exact methods work.
    void begin_exact() noexcept { limit_ = exact_; }
    /// From here on sweeps do, at least so many visits of them.
    void begin_sweeps(int64_t least) noexcept { limit_ = std::max(end_, spent_ + least); }

    void spend(int64_t visits) noexcept { spent_ += visits; }
    int64_t spent() const noexcept { return spent_; }
    bool affords(int64_t visits) const noexcept { return spent_ + visits <= limit_; }
    /// How often so many visits may be made.
    int64_t times(int64_t visits) const noexcept {
        return std::max<int64_t>(0, limit_ - spent_) / std::max<int64_t>(1, visits);
    }

  private:
    static constexpr int64_t kForSweeps = 5;  // one part in so many

    int64_t most_;
    int64_t spent_ = 0;
    int64_t exact_ = 0;
    int64_t end_ = 0;
    int64_t limit_ = 0;
};

}  // namespace dihaptic::contact
