#include "task/plan/taken.h"

#include <algorithm>
#include <cmath>

#include "base/unmeasured.h"

namespace dihaptic::task {

double median_of(std::span<double> x) noexcept {
    if (x.empty()) return kUnmeasured;
    const auto middle = x.begin() + static_cast<std::ptrdiff_t>(x.size() / 2);
    std::nth_element(x.begin(), middle, x.end());
    if (x.size() % 2 == 1) return *middle;
    return (*middle + *std::max_element(x.begin(), middle)) / 2;
}

void Taken::add(double value) {
    if (std::isnan(value)) return;
    const bool first = ticks_++ == 0;
    const auto count = static_cast<double>(ticks_);
    const double off = value - mean_;
    switch (take_) {
        case Take::first:
            if (first) value_ = value;
            break;
        case Take::last:
            value_ = value;
            break;
        case Take::min:
            value_ = first ? value : std::fmin(value_, value);
            break;
        case Take::max:
            value_ = first ? value : std::fmax(value_, value);
            break;
        case Take::mean:
            value_ += (value - value_) / count;
            break;
        case Take::median:
            all_.push_back(value);
            break;
        case Take::sd:
            mean_ += off / count;
            squares_ += off * (value - mean_);
            break;
        case Take::rms:
            squares_ += value * value;
            break;
    }
}

double Taken::statistic() const {
    if (ticks_ == 0) return kUnmeasured;
    const auto count = static_cast<double>(ticks_);
    if (take_ == Take::median) {
        std::vector<double> all = all_;
        return median_of(all);
    }
    if (take_ == Take::sd) return ticks_ > 1 ? std::sqrt(squares_ / (count - 1)) : kUnmeasured;
    if (take_ == Take::rms) return std::sqrt(squares_ / count);
    return value_;
}

}  // namespace dihaptic::task
