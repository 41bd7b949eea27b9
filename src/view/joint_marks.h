// Marks that show a scene's joints: axes, points, rods, and springs with their present stretch.
#pragma once

#include <vector>

#include "frame/frame.h"
#include "scene/scene.h"
#include "view/solids.h"

namespace dihaptic::view {

/// One joint, with its position on the bodies that it joins.
class JointMark {
  public:
    JointMark(const scene::Joint& joint, const scene::Scene& scene);
    /// Adds the mark at the displayed poses of the frame's bodies. `ball`: a ball of radius 1.
    void add_to(Solids& out, const frame::Frame& frame, const gl::Model& ball) const;

  private:
    void add_slider(Solids& out, const Pose& X_WA, const Pose& X_WB) const;

    scene::JointKindRow kind_;
    bool springs_;
    int a_;        // index of the first body; -1: the world
    int b_;        // index of the second body
    Vec3 p_A_;     // the joint's point on the first body
    Vec3 p_B_;     // the joint's point on the second body
    Vec3 axis_A_;  // unit vectors
    Vec3 second_B_;
    Vec3 from_A_;  // start of a slider's spring
};

std::vector<JointMark> joint_marks(const scene::Scene& scene);

}  // namespace dihaptic::view
