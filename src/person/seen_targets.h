// Where a simulated person last saw each target.
#pragma once

#include <optional>
#include <vector>

#include "person/eyes.h"

namespace dihaptic::person {

class SeenTargets {
  public:
    explicit SeenTargets(size_t regions) : positions_(regions, Vec3::Zero()) {}

    void restart() noexcept { seen_ = 0; }
    void see(const Sight& sight) noexcept {
        for (size_t i = 0; i < positions_.size(); ++i) {
            if ((sight.shown >> i & 1u) != 0) positions_[i] = sight.target[i];
        }
        seen_ |= sight.shown;
    }
    /// The position of a region as it is seen now, or else as it was last seen [m]; nothing if it
    /// was never seen.
    std::optional<Vec3> position(size_t region, const Sight& sight) const noexcept {
        if ((sight.shown >> region & 1u) != 0) return sight.target[region];
        if ((seen_ >> region & 1u) != 0) return positions_[region];
        return std::nullopt;
    }

  private:
    std::vector<Vec3> positions_;
    uint32_t seen_ = 0;  // regions that have been seen, one bit per region
};

}  // namespace dihaptic::person
