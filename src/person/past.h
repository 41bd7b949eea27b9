// Past samples of a simulated person's sense, because all senses are delayed.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

namespace dihaptic::person {

template <class Sample>
class Past {
  public:
    /// `longest`: the longest delay [s]. `tick`: time between samples [s].
    Past(double longest, double tick)
        : tick_(tick), samples_(static_cast<size_t>(std::ceil(longest / tick)) + 2) {}

    void clear() noexcept { count_ = 0; }
    void add(const Sample& sample) noexcept { samples_[count_++ % samples_.size()] = sample; }
    bool empty() const noexcept { return count_ == 0; }
    /// The sample taken `delay` seconds before the newest one or, failing that, the oldest sample.
    /// At least one sample must have been added.
    const Sample& before(double delay) const noexcept {
        const auto back = static_cast<size_t>(std::lround(delay / tick_));
        const size_t most = std::min(count_, samples_.size()) - 1;
        return samples_[(count_ - 1 - std::min(back, most)) % samples_.size()];
    }

  private:
    double tick_;
    std::vector<Sample> samples_;
    size_t count_ = 0;
};

}  // namespace dihaptic::person
