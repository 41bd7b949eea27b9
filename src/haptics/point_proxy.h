// PointProxy is a point that stays on surfaces (god_object.h), connected to the handle by a spring
// and a damper, with a reaction on the bodies that it touches. Like the HL library of OpenHaptics,
// it renders everything, including friction, outside the dynamics; the dynamics receive the
// reaction in their next step.
//
//     f = k (p_P - p_H) + c (v_S - v_H)    v_S: surface velocity at P, weighted by pressure
//
// is resolved into the forces of the surfaces: N_i >= 0 along the normal of each surface, and the
// rest T along the surfaces. While the point rests, T is at most sum mu_i N_i; while it slides, T
// is r times that sum, in the direction in which the point lags. Damping acts only while the point
// approaches a surface or sticks: it neither pulls nor makes a smooth surface viscous. A soft
// surface of stiffness k_s gives the fraction k_s / (k + k_s) of N_i: the spring is in series with
// k, though the point stays on the surface.
#pragma once

#include "haptics/coupling.h"
#include "haptics/god_object.h"

namespace dihaptic::haptics {

class PointProxy {
  public:
    /// `body` represents the point in the world.
    PointProxy(const scene::Scene& scene, BodyIndex body, const frame::CouplingSettings& coupling,
               const frame::ProxySettings& settings);

    /// Moves the point to p_WP. Must be called before the first tick.
    void place(World& world, const Vec3& p_WP) noexcept;
    /// Computes one tick of h [s] in a world with a time step of `step` [s]: moves the point,
    /// applies the appropriate share of the reaction to each body that it touches (in the coming
    /// step), and returns the pull on the handle.
    Pull render(World& world, const frame::Handle& handle, double h, double step) noexcept;

    /// Contacts of the last tick, each from the body to the point.
    std::span<const contact::Contact> contacts() const noexcept {
        return {contacts_.data(), count_};
    }

    Onset& onset() noexcept { return onset_; }
    void retune(const frame::CouplingSettings& settings) noexcept { coupling_ = settings; }

  private:
    Vec3 surface_velocity(const World& world) const noexcept;
    double stored(const frame::Handle& handle) const noexcept;
    void resolve(const Vec3& f_W) noexcept;
    /// Updates the surface properties of the bodies.
    void feel_surfaces(const World& world) noexcept;

    frame::CouplingSettings coupling_;
    std::vector<double> shares_;  // for each body: its share of the spring's force
    double share_ = 1;            // share for the touched surfaces
    double popthrough_;           // [N]
    BodyIndex body_;
    GodObject point_;
    Onset onset_;
    std::array<contact::Contact, kMostHalfSpaces> contacts_;
    size_t count_ = 0;
};

}  // namespace dihaptic::haptics
