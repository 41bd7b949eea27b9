// Runs cyclictest, of Debian's rt-tests, which measures how late this machine wakes a real-time
// thread that does nothing else: a reference for the lateness of our own thread.
#pragma once

#include <map>
#include <string>

#include "frame/settings.h"

namespace dihaptic::bench {

/// A histogram of how late wake-ups were.
class Wakeups {
  public:
    /// `us`: whole microseconds, rounded down.
    void add(int us, int64_t count = 1) { counts_[us] += count; }
    int64_t count() const;
    /// Number of wake-ups later than `us` [us].
    int64_t later_than(double us) const;
    /// Quantile of the lateness [us]; NaN without wake-ups.
    double quantile(double share) const;

  private:
    std::map<int, int64_t> counts_;
};

/// Options of cyclictest, which should measure as our thread did: with the same priority and locked
/// memory, or without them if our thread was refused them.
struct Cyclictest {
    frame::Settings settings;
    bool priority = true;
    bool locked_memory = true;
    std::string file;  ///< file for its figures
};

/// Runs cyclictest for `seconds`, and adds its wake-ups. Returns why there are none; "" if all went
/// well.
std::string run_cyclictest(const Cyclictest& wanted, double seconds, Wakeups& wakeups);

}  // namespace dihaptic::bench
