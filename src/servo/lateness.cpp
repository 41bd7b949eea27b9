#include "servo/lateness.h"

#include <algorithm>

namespace dihaptic::servo {
namespace {

constexpr Time kWindow = std::chrono::seconds(1);
constexpr double kEase = 0.1;     // time constant of the low-pass filter for sustained() [s]
constexpr double kExpect = 0.02;  // time constant with which expected() falls after a late tick [s]
constexpr double kWell = 1e-3;    // lateness below this fraction of a period does not count

}  // namespace

Lateness::Lateness(Time period) : period_(period) {
    late_.resize(static_cast<size_t>(kWindow / period) + 2);
}

void Lateness::restart() noexcept {
    count_ = 0;
    sustained_ = 0;
    expected_ = 0;
}

void Lateness::tick(Time now, Time elapsed) noexcept {
    const bool late = 2 * elapsed > 3 * period_;
    // a clock that moved backwards is handled by the caller
    const double t = std::max(0.0, seconds(elapsed));
    while (count_ > 0 && (now - late_[first_].at >= kWindow || count_ == late_.size())) {
        first_ = (first_ + 1) % late_.size();
        --count_;
    }
    if (late) {
        late_[(first_ + count_) % late_.size()] = {now, t};
        ++count_;
    }
    const double well = kWell * seconds(period_);
    expected_ *= kExpect / (kExpect + t);
    if (late) expected_ = std::max(expected_, t - seconds(period_));
    if (expected_ < well) expected_ = 0;
    if (count_ == 0 && sustained_ == 0) return;
    const double mean = this->mean();
    sustained_ += t / (kEase + t) * (mean - sustained_);
    if (mean == 0 && sustained_ < well) sustained_ = 0;
}

double Lateness::mean() const noexcept {
    const double h = seconds(period_);
    double sum = 0;
    double longest = 0;
    for (size_t i = 0; i < count_; ++i) {
        const double t = late_[(first_ + i) % late_.size()].elapsed;
        sum += t * (t - h);
        longest = std::max(longest, t);
    }
    const double rest = seconds(kWindow) - longest;
    // a single late interval is forgiven, even if rounding errors leave a small remainder
    if (count_ < 2 || rest <= 0) return 0;
    return std::max(0.0, sum - longest * (longest - h)) / rest;
}

}  // namespace dihaptic::servo
