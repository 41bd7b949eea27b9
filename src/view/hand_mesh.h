// The skin of a hand that moves with its bones.
#pragma once

#include <vector>

#include "view/hand_pose.h"
#include "view/triangles.h"

namespace dihaptic::view {

class HandMesh {
  public:
    /// Makes the skin of the open hand. Takes about 0.1 s.
    HandMesh();

    /// The skin in a pose, in W. Each vertex moves with the bones around it (linear blend
    /// skinning).
    Triangles posed(const HandPose& pose) const;

  private:
    static constexpr size_t kBonesPerVertex = 4;  // the palm, and the bones of one finger
    struct Hold {
        size_t finger = 0;
        std::array<double, kBonesPerVertex> weights{};
    };
    Triangles open_;
    std::vector<Hold> holds_;  // by vertex
};

}  // namespace dihaptic::view
