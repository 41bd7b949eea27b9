// PointProxy is a point kept on surfaces (god_object.h), with a spring and a damper from the handle
// to it, and the reaction on what it touches. It renders as OpenHaptics' HL did, friction included:
// outside the dynamics, which feel the reaction in their next step.
//
//     f = k (p_P - p_H) + c (v_S - v_H)      v_S: of the surfaces at P, weighted by pressure
//
// is resolved into what each surface can give: N_i along its normal, at least 0, and the rest T
// along the surfaces. While the point rests, T is at most sum mu_i N_i; while it slides, T is r
// times that, toward where the point stayed behind. Damping acts only on the approach to surfaces
// and on sticking: it neither pulls nor makes a smooth surface viscous.
#pragma once

#include "haptics/coupling.h"
#include "haptics/god_object.h"

namespace dihaptic::haptics {

class PointProxy {
  public:
    /// The proxy of the scene's finger `finger`; `body` represents it in the world.
    PointProxy(const scene::Scene& scene, size_t finger, BodyIndex body,
               const CouplingSettings& coupling, const ProxySettings& settings);

    /// Puts the point somewhere, before the first tick.
    void place(World& world, const Vec3& p_WP) noexcept;
    /// Does one tick of h [s] in a world with a time step of `step` [s]: moves the point, applies
    /// to each body that it touches its share of the reaction in the coming step, and returns the
    /// pull on the handle.
    Pull render(World& world, const Handle& handle, double h, double step) noexcept;

    /// Contacts of the last tick, from body to point.
    std::span<const contact::Contact> contacts() const noexcept {
        return {contacts_.data(), count_};
    }

    Onset& onset() noexcept { return onset_; }
    void retune(const CouplingSettings& settings) noexcept { coupling_ = settings; }
    void set_friction_scale(double scale) noexcept { point_.set_friction_scale(scale); }

  private:
    Vec3 surface_velocity(const World& world) const noexcept;
    double stored(const Handle& handle) const noexcept;
    void resolve(const Vec3& f_W) noexcept;

    CouplingSettings coupling_;
    double popthrough_;  // [N]
    BodyIndex body_;
    GodObject point_;
    Onset onset_;
    std::array<contact::Contact, kMostHalfSpaces> contacts_;
    size_t count_ = 0;
};

}  // namespace dihaptic::haptics
