// cyclictest, of Debian's rt-tests: the ruler of how late this machine wakes a real-time thread
// that does nothing else. Measured beside our own thread, as a peer.
#pragma once

#include <map>
#include <string>

#include "servo/settings.h"

namespace dihaptic::measure {

/// How late wake-ups were.
class Wakeups {
  public:
    /// `us`: whole microseconds, rounded down.
    void add(int us, int64_t count = 1) { counts_[us] += count; }
    int64_t count() const;
    /// How many were later than this.
    int64_t later_than(double us) const;
    /// The share-quantile [us]; NaN without wake-ups.
    double quantile(double share) const;

  private:
    std::map<int, int64_t> counts_;
};

/// What cyclictest is to measure, as our thread did: with the same priority and locked memory, or
/// without where that was refused us.
struct Cyclictest {
    servo::Settings settings;
    bool priority = true;
    bool locked_memory = true;
    std::string file;  ///< that it may write its figures to
};

/// Adds its wake-ups of so many seconds. Returns why there are none; "" when all went well.
std::string run_cyclictest(const Cyclictest& wanted, double seconds, Wakeups& wakeups);

}  // namespace dihaptic::measure
