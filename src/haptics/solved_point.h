// SolvedPoint is a point proxy whose friction is solved together with the dynamics: a body without
// mass, shape or rotation of its own, which the implicit coupling pulls to the handle (README.md).
// Its possible contacts in a step are found as for any point on surfaces (god_object.h). They
// become contacts of the step, like all others of the touched bodies, with Coulomb's cone and, for
// a soft finger, torsion. The handle feels the contact forces, so momentum is conserved between the
// hand and the bodies.
#pragma once

#include "haptics/coupling.h"
#include "haptics/god_object.h"

namespace dihaptic::haptics {

class SolvedPoint {
  public:
    /// Creates the proxy of a finger of the scene; `body` represents the proxy in the world.
    SolvedPoint(const scene::Scene& scene, BodyIndex body, const frame::CouplingSettings& coupling,
                const frame::ProxySettings& settings);

    /// Moves the point to p_WP. Must be called before the first tick.
    void place(World& world, const Vec3& p_WP) noexcept;
    /// Must be called before and after a step of the world of h [s].
    void before_step(World& world, const frame::Handle& handle, double h) noexcept;
    void after_step(World& world, const frame::Handle& handle) noexcept;
    /// Returns the current force on the handle: the force of the step's contacts or, in a tick of h
    /// [s] without a step, the current force of the spring on those contacts. A surface that is
    /// first touched in this tick is felt at once, and its body gets the reaction in the next step.
    /// Between steps, only the part of the spring that acts counts as stored energy.
    Pull pull(World& world, const frame::Handle& handle, double h) noexcept;

    Onset& onset() noexcept { return onset_; }
    void retune(const frame::CouplingSettings& settings) noexcept { coupling_ = settings; }

  private:
    struct Press {
        Vec3 n_W;  ///< unit normal, out of the body
        double friction;
        double share;  ///< fraction of the spring's force that remains on a soft surface
    };

    /// The fraction of the spring's force that remains if a body's surface is in series with the
    /// spring.
    double share_of(const World& world, BodyIndex body) const noexcept;
    Vec3 in_cones(const Vec3& spring) const noexcept;
    double energy(const Vec3& stretch) const noexcept;
    Vec3 meet_between_steps(World& world, const frame::Handle& handle, double h) noexcept;

    frame::CouplingSettings coupling_;
    Onset onset_;
    BodyIndex body_;
    GodObject point_;
    double sliding_friction_;
    double popthrough_;                                        // [N]
    std::array<Press, dynamics::kMostPointContacts> presses_;  // surfaces pressed in the last step
    size_t press_count_ = 0;
    double share_ = 1;  // share over all pressed surfaces
    bool sliding_ = false;
    bool just_stepped_ = false;
    double step_ = 0;  // time step of the world [s]
    double mass_ = 0;  // mass of the point in the last step [kg]
    Vec3 v_WP_ = Vec3::Zero();
    Vec3 f_P_W_ = Vec3::Zero();  // total force of the last step's contacts [N]
};

}  // namespace dihaptic::haptics
