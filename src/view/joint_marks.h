// Marks that show the joints of a scene: axes, points, rods, and springs with their current
// stretch.
#pragma once

#include <vector>

#include "frame/frame.h"
#include "scene/scene.h"
#include "view/solids.h"

namespace dihaptic::view {

/// The mark of one joint, with its position on the two connected bodies.
class JointMark {
  public:
    JointMark(const scene::Joint& joint, const scene::Scene& scene);
    /// Adds the mark, with the bodies at their displayed poses in the frame. `ball`: a model of a
    /// ball of radius 1.
    void add_to(Solids& out, const frame::Frame& frame, const gl::Model& ball) const;

  private:
    void add_slider(Solids& out, const Pose& X_WA, const Pose& X_WB) const;

    scene::JointKindRow kind_;
    bool springs_;
    int a_;        // index of the first body; -1 for the world
    int b_;        // index of the second body
    Vec3 p_A_;     // position of the joint on the first body
    Vec3 p_B_;     // position of the joint on the second body
    Vec3 axis_A_;  // unit vectors
    Vec3 second_B_;
    Vec3 from_A_;  // start of the spring of a slider
};

std::vector<JointMark> joint_marks(const scene::Scene& scene);

}  // namespace dihaptic::view
