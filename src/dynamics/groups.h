// Groups bodies that touch, anew in each step (union-find with path halving). Bodies that do not
// touch each other, either directly or through other movable bodies, are solved and put to sleep
// separately.
#pragma once

#include <numeric>
#include <vector>

namespace dihaptic::dynamics {

class Groups {
  public:
    explicit Groups(size_t bodies) : parent_(bodies) {}

    /// Puts each body into its own group.
    void reset() noexcept { std::iota(parent_.begin(), parent_.end(), size_t{0}); }
    void join(size_t a, size_t b) noexcept {
        const size_t root_a = of(a);
        const size_t root_b = of(b);
        // the smallest index represents the group, regardless of the order of joining
        parent_[std::max(root_a, root_b)] = std::min(root_a, root_b);
    }
    /// Returns the body that represents the group of `body`.
    size_t of(size_t body) noexcept {
        while (parent_[body] != body) {
            parent_[body] = parent_[parent_[body]];
            body = parent_[body];
        }
        return body;
    }

  private:
    std::vector<size_t> parent_;
};

}  // namespace dihaptic::dynamics
