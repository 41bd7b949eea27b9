// The point proxy whose friction is solved together with the dynamics: a body without mass, shape
// or turn of its own, which the implicit coupling pulls to the handle (README.md). What it may meet
// in a step is found as for any point on surfaces (god_object.h), and becomes contacts of the step:
// with Coulomb's cone and, for a soft finger, torsion, among all other contacts of what it touches.
// The handle feels the contact forces, so nothing is gained or lost between hand and bodies.
#pragma once

#include "haptics/coupling.h"
#include "haptics/god_object.h"

namespace dihaptic::haptics {

class SolvedPoint {
  public:
    /// A finger of the scene; `body` stands for it in the world.
    SolvedPoint(const scene::Scene& scene, BodyIndex body, const CouplingSettings& coupling,
                const ProxySettings& settings);

    /// Puts it somewhere, before the first tick.
    void place(World& world, const Vec3& p_WP) noexcept;
    /// Around a step of the world h [s].
    void before_step(World& world, const Handle& handle, double h) noexcept;
    void after_step(World& world, const Handle& handle) noexcept;
    /// On the handle now: the force of the step's contacts. In a tick h [s] without a step, what
    /// the spring asks of them now; a surface that only this tick has met is felt at once, and its
    /// body gets the reaction in the next step. Between steps, what acts of the spring counts as
    /// stored.
    Pull pull(World& world, const Handle& handle, double h) noexcept;

    Onset& onset() noexcept { return onset_; }
    void retune(const Tuning& tuning) noexcept { coupling_.set(tuning); }

  private:
    struct Press {
        Vec3 n_W;  ///< out of the body
        double friction;
    };

    Vec3 in_cones(const Vec3& spring) const noexcept;
    double energy(const Vec3& stretch) const noexcept;
    Vec3 meet_between_steps(World& world, const Handle& handle, double h) noexcept;

    CouplingSettings coupling_;
    Onset onset_;
    BodyIndex body_;
    GodObject point_;
    double sliding_friction_;
    double popthrough_;                                        // [N]
    std::array<Press, dynamics::kMostPointContacts> presses_;  // in the last step
    size_t press_count_ = 0;
    bool sliding_ = false;
    bool just_stepped_ = false;
    double step_ = 0;  // of the world [s]
    Vec3 v_WP_ = Vec3::Zero();
    Vec3 f_P_W_ = Vec3::Zero();  // of the last step's contacts [N]
};

}  // namespace dihaptic::haptics
