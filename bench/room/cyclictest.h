// Runs cyclictest, from Debian's rt-tests, which measures the lateness with which this machine
// wakes a real-time thread without work: a reference for the lateness of our own thread.
#pragma once

#include <map>
#include <string>

#include "frame/settings.h"

namespace dihaptic::bench {

/// A histogram of the lateness of wake-ups.
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

/// Options of cyclictest, which should run like our thread: with the same priority and locked
/// memory, or without whichever of them our thread was refused.
struct Cyclictest {
    frame::Settings settings;
    bool priority = true;
    bool locked_memory = true;
    std::string file;  ///< file for its figures
};

/// Runs cyclictest for `seconds`, and adds its wake-ups. Returns the reason if there are none; ""
/// on success.
std::string run_cyclictest(const Cyclictest& wanted, double seconds, Wakeups& wakeups);

}  // namespace dihaptic::bench
