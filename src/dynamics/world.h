// The World: rigid bodies under gravity, contact and friction. One step is
//
//     v <- v + h (g + f/m),  w <- w + h I^-1 torque      everything but contacts, on the velocities
//     find contacts; solve for contact impulses           velocities now obey contact and friction
//     x <- x + h v,  R <- exp(h w) R                      semi-implicit Euler
//
// so that the solver's friction sees all of the step's loads (applied torques too, which Bullet's
// own order hides from it). Bodies that are at rest and touch nothing that moves sleep: they cost
// nothing and stay exactly where they are (sleep.h).
//
// Set-up may allocate and throw; after activate() a step does neither.
#pragma once

#include <functional>
#include <memory>
#include <span>
#include <string>

#include "contact/contact.h"
#include "contact/solver.h"
#include "dynamics/settings.h"
#include "scene/scene.h"

namespace dihaptic::dynamics {

using contact::BodyIndex;

struct BodyState {
    Pose X_WB;
    Vec3 v_WB = Vec3::Zero();  ///< of B's origin [m/s]
    Vec3 w_WB = Vec3::Zero();  ///< angular velocity [rad/s]
    bool awake = true;         ///< false: asleep or fixed; the state does not change
};

/// What a body's properties are times those of the scene.
struct BodyProperties {
    Vec3 mass = Vec3::Ones();  ///< its inertia along the world's axes
    double weight = 1;
    double turning = 1;   ///< its moments of inertia
    double friction = 1;  ///< its coefficients with all others
    bool operator==(const BodyProperties&) const = default;
};

/// What a step could not do as asked.
enum class StepStatus : unsigned {
    ok = 0,
    contacts_full = 1u << 0,  ///< more contacts than reserved: memory was allocated, and contacts()
                              ///< leaves the rest out. Raise dynamics.max_contacts.
    diverged = 1u << 1,       ///< a place or a speed is no number, or has no more to do with this
                              ///< world: no step does anything from then on, until mend()
};

/// Nothing that belongs to an experiment is as far away or as fast: what falls for half a day is
/// 1e10 m away. Beyond, squares of squares overflow [m], [m/s], [rad/s].
constexpr double kBeyond = 1e12;

/// What a point may meet in one step.
constexpr size_t kMostPointContacts = 6;

class World {
  public:
    /// All bodies of the scene, at their initial poses.
    World(const scene::Scene& scene, const Settings& settings);
    ~World();
    World(World&&) noexcept;
    World& operator=(World&&) noexcept;

    /// Adds a finger's proxy at a position. Gravity does not act on it. It does not turn, or else
    /// turns about P, with the same inertia about all axes: its mean about P.
    BodyIndex add_proxy(const scene::Finger& finger, const Vec3& p_WP, bool turns = false);
    /// The same of one that set_point() may make a point.
    BodyIndex add_changeable_proxy(const scene::Finger& finger, const Vec3& p_WP,
                                   bool turns = false);
    /// Adds a finger whose proxy is a point. It meets nothing but what meet() says.
    BodyIndex add_point(const scene::Finger& finger, const Vec3& p_WP, bool turns = false);
    /// Reserves all memory that steps need.
    void activate();

    /// Makes a changeable proxy a point from the next step on, or again a body with its shape.
    void set_point(BodyIndex proxy, bool point) noexcept;

    int size() const;        ///< number of bodies, proxies included
    int scene_size() const;  ///< number of bodies of the scene: indices below this one
    BodyIndex find(const std::string& name) const;
    const std::string& name(BodyIndex body) const;
    /// Coefficient of friction between two bodies.
    double friction(BodyIndex a, BodyIndex b) const;

    /// States after the last step.
    std::span<const BodyState> states() const { return states_; }
    const BodyState& state(BodyIndex body) const {
        return states_[static_cast<size_t>(body.value)];
    }
    /// Bodies that took part in the last step: all others are where they were.
    std::span<const size_t> stepped() const;
    /// Contacts of the last step, those of sleeping bodies left out.
    std::span<const contact::Contact> contacts() const { return contacts_; }
    const contact::SolveStats& solve_stats() const { return stats_; }
    double mass(BodyIndex body) const;
    /// Of a proxy that turns, about P [kg*m^2].
    double inertia(BodyIndex proxy) const;
    const Vec3& gravity() const { return gravity_; }

    /// The mass that the next steps see [kg].
    void set_mass(BodyIndex body, double mass) noexcept;
    /// The properties of a body of the scene from the next step on; it wakes when they change.
    void set_properties(BodyIndex body, const BodyProperties& properties) noexcept;
    /// Every coefficient of friction times a factor, from the next step on; all wake.
    void set_friction_scale(double scale) noexcept;
    double friction_scale() const noexcept;
    /// Of B's origin.
    void set_velocity(BodyIndex body, const Vec3& v_WB) noexcept;
    /// The same for a proxy that turns: inertia about P [kg*m^2], angular velocity [rad/s].
    void set_inertia(BodyIndex proxy, double inertia) noexcept;
    void set_angular_velocity(BodyIndex proxy, const Vec3& w_WP) noexcept;
    /// Turns a proxy that does not turn by itself: its orientation, and the angular velocity at
    /// which it goes on, whatever it touches. P keeps its velocity.
    void carry(BodyIndex proxy, const Quat& R_WP, const Vec3& w_WP) noexcept;
    /// Puts a body somewhere else, at rest.
    void set_pose(BodyIndex body, const Pose& X_WB) noexcept;
    /// Adds to the load of the next step: a force at the centre of mass [N] and a torque [N*m].
    void apply(BodyIndex body, const Vec3& force_W, const Vec3& torque_W) noexcept;
    /// The same for a force that acts at p_W [m].
    void apply_at(BodyIndex body, const Vec3& force_W, const Vec3& p_W) noexcept;
    /// Where a point is, and how fast it got there.
    void set_point(BodyIndex point, const Vec3& p_WP, const Vec3& v_WP) noexcept;
    /// What a point may meet in the next step: a face of a body, with the normal out of it at the
    /// point, which is `gap` [m] off. Of the pair's friction only a share acts.
    struct PointContact {
        BodyIndex body;
        int part = 0;  ///< with the face: the same goes on from its last impulse
        int face = 0;
        Vec3 n_W = Vec3::UnitZ();
        double gap = 0;
        double friction_share = 1;
    };
    /// Up to kMostPointContacts of them in a step.
    void meet(BodyIndex point, const PointContact& contact) noexcept;

    /// The solver of the next steps; it starts from the last one's impulses.
    void set_solver(Solver solver) noexcept;
    Solver solver() const noexcept;

    /// Shows each problem, and the impulses that its solve starts from, before it is solved. For
    /// benches: what it does is part of the step, and must not throw.
    using ProblemWatcher = std::function<void(const contact::ContactProblem& problem,
                                              std::span<const contact::Impulse> start)>;
    void watch_problems(ProblemWatcher watcher);

    /// Steps by h [s].
    StepStatus step(double h) noexcept;
    /// Whether a step, or somebody who set a pose or a velocity, left the world with what is no
    /// number.
    bool diverged() const noexcept;
    /// After it has, between two steps: what is nowhere is put back to where the scene has it, at
    /// rest, and what contacts remember is forgotten.
    void mend() noexcept;

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
    std::vector<BodyState> states_;
    std::vector<contact::Contact> contacts_;
    contact::SolveStats stats_;
    Vec3 gravity_;
};

}  // namespace dihaptic::dynamics
