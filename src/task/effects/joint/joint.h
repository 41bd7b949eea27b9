// Factors on a joint's properties in the scene. If several perturbations change the same joint,
// their factors multiply.
#pragma once

#include "frame/task_frame.h"
#include "scene/scene.h"
#include "task/effects/factor.h"
#include "task/effects/load/motions.h"
#include "task/file/ref.h"

namespace dihaptic::task {

class Names;
class JointEffect;

struct JointSpec {
    using Effect = JointEffect;

    Ref<scene::Joint> joint;
    Formula stiffness_scale = 1;  ///< factor on the stiffness of the joint's spring
    Formula damping_scale = 1;    ///< factor on the damping of the joint's damper
    Formula friction_scale = 1;
    Place place;

    template <class Visitor>
    void visit(Visitor& v) {
        const Field factor = Field::number().within(0, 100);
        v("joint", joint, Field::text().required().says("Joint whose properties are changed."));
        v("stiffness_scale", stiffness_scale,
          factor.says("Factor on the stiffness of the joint's spring."));
        v("damping_scale", damping_scale,
          factor.says("Factor on the damping of the joint's damper."));
        v("friction_scale", friction_scale, factor.says("Factor on the joint's dry friction."));
    }
};

/// Appends descriptions of the changes and their sizes to `out`, for a report.
void say(const JointSpec& spec, std::vector<std::string>& out);

class JointEffect {
  public:
    /// Problems in the spec are added to `diagnostics`.
    JointEffect(const JointSpec& spec, const Names& names, const scene::Scene& scene,
                Diagnostics& diagnostics);

    void order(double share, std::span<const Vec3> regions_W, const Motions& motions,
               frame::TaskFrame& out) const noexcept;
    template <class Visitor>
    void visit(Visitor& v) {
        spec_.visit(v);
    }

  private:
    JointSpec spec_;
};

}  // namespace dihaptic::task
