// PointProxy is a point kept on surfaces (god_object.h), with a spring and a damper from the handle
// to it, and the reaction on touched bodies. It renders like OpenHaptics' HL, including friction,
// outside the dynamics, which receive the reaction in their next step.
//
//     f = k (p_P - p_H) + c (v_S - v_H)      v_S: of the surfaces at P, weighted by pressure
//
// is resolved into the surfaces' forces: N_i along the normal of each, at least 0, and the rest T
// along the surfaces. While the point rests, T is at most sum mu_i N_i; while it slides, T is r
// times that, toward the point's lag. Damping acts only on the approach to surfaces and on
// sticking: it neither pulls nor makes a smooth surface viscous. A soft surface of stiffness k_s
// gives the fraction k_s / (k + k_s) of N_i: the spring is in series with k, though the point stays
// on the surface.
#pragma once

#include "haptics/coupling.h"
#include "haptics/god_object.h"

namespace dihaptic::haptics {

class PointProxy {
  public:
    /// `body` represents the point in the world.
    PointProxy(const scene::Scene& scene, BodyIndex body, const frame::CouplingSettings& coupling,
               const frame::ProxySettings& settings);

    /// Places the point, before the first tick.
    void place(World& world, const Vec3& p_WP) noexcept;
    /// Does one tick of h [s] in a world with a time step of `step` [s]: moves the point, applies
    /// to each body that it touches its share of the reaction in the coming step, and returns the
    /// pull on the handle.
    Pull render(World& world, const frame::Handle& handle, double h, double step) noexcept;

    /// Contacts of the last tick, from body to point.
    std::span<const contact::Contact> contacts() const noexcept {
        return {contacts_.data(), count_};
    }

    Onset& onset() noexcept { return onset_; }
    void retune(const frame::CouplingSettings& settings) noexcept { coupling_ = settings; }

  private:
    Vec3 surface_velocity(const World& world) const noexcept;
    double stored(const frame::Handle& handle) const noexcept;
    void resolve(const Vec3& f_W) noexcept;
    /// Updates the surfaces of the bodies.
    void feel_surfaces(const World& world) noexcept;

    frame::CouplingSettings coupling_;
    std::vector<double> shares_;  // by body, of the spring's force
    double share_ = 1;            // for the touched surfaces
    double popthrough_;           // [N]
    BodyIndex body_;
    GodObject point_;
    Onset onset_;
    std::array<contact::Contact, kMostHalfSpaces> contacts_;
    size_t count_ = 0;
};

}  // namespace dihaptic::haptics
