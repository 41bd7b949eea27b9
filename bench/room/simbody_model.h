// A tree of bodies on hinges in Simbody. Its headers do not compile as C++20, so code that includes
// them is kept separate, and this header is C++17.
#pragma once

#include <memory>
#include <vector>

#include "base/geometry.h"

namespace dihaptic::bench::simbody {

/// A body carried by a hinge.
struct Link {
    int parent = -1;              ///< index of an earlier link; -1: the world
    double mass = 0;              ///< [kg]
    Vec3 inertia = Vec3::Zero();  ///< about its centre (its origin) along its axes [kg*m^2]
    Pose X_PJ;                    ///< of the hinge, its axis along z, in the parent at the start
    Pose X_BJ;                    ///< of the hinge, in the body
};

/// The kind of steps: chosen by the integrator for its own accuracy, or Euler's
/// semi-explicit steps.
enum class Steps { chosen, of_1_ms };

class Model {
  public:
    Model(const std::vector<Link>& links, const Vec3& gravity, Steps steps);
    ~Model();
    Model(const Model&) = delete;
    Model& operator=(const Model&) = delete;

    /// Advances to a time [s], and writes the links' poses at that time.
    void step_to(double time, std::vector<Pose>& X_WB);

  private:
    struct Parts;
    std::unique_ptr<Parts> parts_;
};

}  // namespace dihaptic::bench::simbody
