// SolvedPoint is a point proxy whose friction is solved together with the dynamics: a body without
// mass, shape or rotation of its own, which the implicit coupling pulls to the handle (README.md).
// Its possible contacts in a step are found as for any point on surfaces (god_object.h) and become
// contacts of the step, with Coulomb's cone and, for a soft finger, torsion, among all other
// contacts of touched bodies. The handle feels the contact forces, so no momentum is gained or
// lost between hand and bodies.
#pragma once

#include "haptics/coupling.h"
#include "haptics/god_object.h"

namespace dihaptic::haptics {

class SolvedPoint {
  public:
    /// The proxy of a finger of the scene; `body` represents it in the world.
    SolvedPoint(const scene::Scene& scene, BodyIndex body, const frame::CouplingSettings& coupling,
                const frame::ProxySettings& settings);

    /// Places the point, before the first tick.
    void place(World& world, const Vec3& p_WP) noexcept;
    /// Called before and after a step of the world of h [s].
    void before_step(World& world, const frame::Handle& handle, double h) noexcept;
    void after_step(World& world, const frame::Handle& handle) noexcept;
    /// The present force on the handle: that of the step's contacts. In a tick of h [s] without a
    /// step, it is the spring's present force on those contacts. A surface first touched in this
    /// tick is felt at once, and its body gets the reaction in the next step. Between steps, only
    /// the acting part of the spring counts as stored energy.
    Pull pull(World& world, const frame::Handle& handle, double h) noexcept;

    Onset& onset() noexcept { return onset_; }
    void retune(const frame::CouplingSettings& settings) noexcept { coupling_ = settings; }

  private:
    struct Press {
        Vec3 n_W;  ///< out of the body
        double friction;
        double share;  ///< fraction of the spring's force that a soft surface gives
    };

    /// The fraction of the spring's force that a body's surface, in series with it, gives.
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
    std::array<Press, dynamics::kMostPointContacts> presses_;  // in the last step
    size_t press_count_ = 0;
    double share_ = 1;  // over all pressed surfaces
    bool sliding_ = false;
    bool just_stepped_ = false;
    double step_ = 0;  // of the world [s]
    double mass_ = 0;  // of the point in the last step [kg]
    Vec3 v_WP_ = Vec3::Zero();
    Vec3 f_P_W_ = Vec3::Zero();  // of the last step's contacts [N]
};

}  // namespace dihaptic::haptics
