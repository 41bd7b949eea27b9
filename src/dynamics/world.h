// World simulates rigid bodies under gravity, contact and friction. One step is
//
//     v <- v + h (g + f/m),  w <- w + h I^-1 torque      all loads but contacts, on velocities
//     find contacts; solve for contact impulses          velocities now obey contact and friction
//     x <- x + h v,  R <- exp(h w) R                     semi-implicit Euler
//
// so that the solver's friction sees all loads of the step, including applied torques, which
// Bullet's own order hides from it. Bodies at rest that touch no moving body sleep:
// they cost nothing and do not move at all (sleep.h).
//
// Set-up may allocate and throw; after activate() a step does neither.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include "contact/contact.h"
#include "contact/solver.h"
#include "dynamics/balance.h"
#include "frame/dynamics_settings.h"
#include "scene/scene.h"

namespace dihaptic::dynamics {

using contact::BodyIndex;

struct BodyState {
    Pose X_WB;
    Vec3 v_WB = Vec3::Zero();  ///< of B's origin [m/s]
    Vec3 w_WB = Vec3::Zero();  ///< angular velocity [rad/s]
    bool awake = true;         ///< false: asleep or fixed; the state does not change
};

/// State of a joint of the scene. A hinge or slider has a coordinate: its second body's
/// position relative to the first, 0 at the start.
struct JointState {
    scene::JointKind kind = scene::JointKind::hinge;
    double position = 0;           ///< [rad] or [m]
    double velocity = 0;           ///< [rad/s] or [m/s]
    Vec3 force_W = Vec3::Zero();   ///< of the first body on the second, at the joint [N]
    Vec3 torque_W = Vec3::Zero();  ///< including spring, friction and stops [N*m]
};

/// Factors between a body's properties and the scene's. If the scene gives a surface for a pair,
/// they change only its friction.
struct BodyProperties {
    Vec3 mass = Vec3::Ones();  ///< for its inertia along the world's axes
    double weight = 1;
    double turning = 1;      ///< for its moments of inertia
    double friction = 1;     ///< for its coefficients with all other bodies
    double stiffness = 1;    ///< for its own surface, with the damping
    double restitution = 1;  ///< for its own surface, whose restitution stays at most 1
    double texture_wavelength = 1;
    double texture_height = 1;    ///< within the limits of scene::Texture::scale()
    double texture_friction = 1;  ///< for the variation of friction along its texture
    bool operator==(const BodyProperties&) const = default;
};

/// Factors between a joint's properties and the scene's.
struct JointProperties {
    double stiffness = 1;
    double damping = 1;
    double friction = 1;  ///< dry
    bool operator==(const JointProperties&) const = default;
};

/// The action of a motor on a joint that has a coordinate.
struct Motor {
    std::optional<double> position;  ///< the joint's target at the end of the step
    double most_force = 0;           ///< largest force of this motion [N] or [N*m]
    double push = 0;  ///< additional force of the first body on the second [N] or [N*m]
};

/// The reasons why a step was incomplete.
enum class StepStatus : unsigned {
    ok = 0,
    contacts_full = 1u << 0,  ///< more contacts than reserved: memory was allocated, and contacts()
                              ///< lacks the rest. Raise dynamics.max_contacts.
    diverged = 1u << 1,  ///< a position or speed is not a number, or is beyond kBeyond: steps do
                         ///< nothing until mend()
};

/// No object in an experiment is this far away or this fast: a free fall of half a day covers 1e10
/// m. Beyond this limit, squares of squares overflow [m], [m/s], [rad/s].
constexpr double kBeyond = 1e12;

/// Largest number of contacts of a point in one step.
constexpr size_t kMostPointContacts = 6;

using contact::Solver;
using Settings = frame::DynamicsSettings;

class World {
  public:
    /// A world with all bodies of the scene at their initial poses.
    World(const scene::Scene& scene, const frame::DynamicsSettings& settings);
    ~World();
    World(World&&) noexcept;
    World& operator=(World&&) noexcept;

    /// Adds a finger's proxy at a position. Gravity does not act on it. If it turns, it turns about
    /// P, with the same inertia about all axes: its mean about P.
    BodyIndex add_proxy(const scene::Finger& finger, const Vec3& p_WP, bool turns = false);
    /// Adds a proxy that set_point() can turn into a point.
    BodyIndex add_changeable_proxy(const scene::Finger& finger, const Vec3& p_WP,
                                   bool turns = false);
    /// Adds a finger whose proxy is a point. It has only the contacts that meet() adds.
    BodyIndex add_point(const scene::Finger& finger, const Vec3& p_WP, bool turns = false);
    /// Reserves all memory that steps need.
    void activate();

    /// Makes a changeable proxy a point from the next step on, or again a body with its shape.
    void set_point(BodyIndex proxy, bool point) noexcept;

    int size() const;        ///< number of bodies, including proxies
    int scene_size() const;  ///< number of bodies of the scene: indices below this one
    BodyIndex find(const std::string& name) const;
    const std::string& name(BodyIndex body) const;
    /// Coefficient of friction between two bodies.
    double friction(BodyIndex a, BodyIndex b) const;
    /// The same, including the textures of both, if b touches a face of a with the normal n_W at
    /// p_W.
    double friction_at(BodyIndex a, BodyIndex b, const Vec3& p_W, const Vec3& n_W) const noexcept;
    /// The combined surface of two bodies, with the friction that the scene gives.
    const scene::PairSurface& surface(BodyIndex a, BodyIndex b) const;

    /// States after the last step.
    std::span<const BodyState> states() const { return states_; }
    const BodyState& state(BodyIndex body) const {
        return states_[static_cast<size_t>(body.value)];
    }
    /// Bodies that took part in the last step, and fixed bodies moved before it. No
    /// other body has moved.
    std::span<const size_t> stepped() const;
    /// Contacts of the last step, except those of sleeping bodies.
    std::span<const contact::Contact> contacts() const { return contacts_; }
    /// Statistics of the last step, combined over its islands, which are solved separately.
    const contact::SolveStats& solve_stats() const { return stats_; }
    /// The largest residual of the islands with a finger in the last step: 0 without such islands.
    double held_residual() const noexcept;
    /// The books of the last step.
    const Balance& balance() const noexcept;
    /// Whether a body moved less far in the last step than its velocity implies, because it
    /// would have entered another.
    bool held_back() const noexcept;
    /// Joints of the scene that are recorded, in its order, after the last step.
    std::span<const JointState> joints() const noexcept;
    double mass(BodyIndex body) const;
    /// Inertia of a proxy that turns, about P [kg*m^2].
    double inertia(BodyIndex proxy) const;
    const Vec3& gravity() const { return gravity_; }

    /// Sets the mass of a body in the next steps [kg].
    void set_mass(BodyIndex body, double mass) noexcept;
    /// Sets the properties of a body of the scene from the next step on; it wakes if they change.
    /// For a fixed body only the friction applies, and all other bodies wake.
    void set_properties(BodyIndex body, const BodyProperties& properties) noexcept;
    /// Multiplies every coefficient of friction from the next step on; all bodies wake.
    void set_friction_scale(double scale) noexcept;
    double friction_scale() const noexcept;
    /// Sets the velocity of B's origin.
    void set_velocity(BodyIndex body, const Vec3& v_WB) noexcept;
    /// Sets the velocity of B's origin and the angular velocity of a body that is not fixed or
    /// driven, as far as its constraints allow.
    void set_motion(BodyIndex body, const Vec3& v_WB, const Vec3& w_WB) noexcept;
    /// For a proxy that turns: inertia about P [kg*m^2] and angular velocity [rad/s].
    void set_inertia(BodyIndex proxy, double inertia) noexcept;
    void set_angular_velocity(BodyIndex proxy, const Vec3& w_WP) noexcept;
    /// Turns a proxy that cannot turn by itself: sets its orientation, and the angular velocity at
    /// which it keeps turning in spite of contacts. P keeps its velocity.
    void carry(BodyIndex proxy, const Quat& R_WP, const Vec3& w_WP) noexcept;
    /// Moves a body to another pose, at rest. If it is fixed or asleep, all other bodies wake.
    void set_pose(BodyIndex body, const Pose& X_WB) noexcept;
    /// Moves a body that is not fixed to a pose within the next step, in spite of contacts; it
    /// keeps the velocity that takes it there. A body declared as driven in the scene stays in
    /// place without such a call.
    void drive(BodyIndex body, const Pose& X_WB) noexcept;
    /// Sets the properties of a joint from the next step on; its bodies wake if they change.
    void set_joint_properties(size_t joint, const JointProperties& properties) noexcept;
    /// Drives a joint in the next step. A motor with a target position overcomes the joint's dry
    /// friction by itself, and approaches no faster than half of its force could stop.
    void drive_joint(size_t joint, const Motor& motor) noexcept;
    /// Adds to the loads of the next step: a force at the centre of mass [N] and a torque [N*m].
    void apply(BodyIndex body, const Vec3& force_W, const Vec3& torque_W) noexcept;
    /// Adds a force that acts at p_W [m] to the loads of the next step.
    void apply_at(BodyIndex body, const Vec3& force_W, const Vec3& p_W) noexcept;
    /// Sets the position and velocity of a point.
    void set_point(BodyIndex point, const Vec3& p_WP, const Vec3& v_WP) noexcept;
    /// A contact that a point may make in the next step: with a face of a body, `gap` [m] away; the
    /// normal points out of the body at the point. Only a fraction of the pair's friction acts.
    struct PointContact {
        BodyIndex body;
        int part = 0;  ///< a contact with the same part and face starts from its last impulse
        int face = 0;
        Vec3 n_W = Vec3::UnitZ();
        double gap = 0;
        double friction_share = 1;
        double compliance = 0;  ///< along the normal: yielding velocity of the point [m/s per N*s]
    };
    /// Adds a contact of a point; up to kMostPointContacts in a step.
    void meet(BodyIndex point, const PointContact& contact) noexcept;

    /// Sets the solver of the next steps; it starts from the last step's impulses.
    void set_solver(contact::Solver solver) noexcept;
    contact::Solver solver() const noexcept;

    /// Called before each solve, with the problem and the initial impulses.
    /// For benchmarks: the call is part of the step, and must not throw.
    using ProblemWatcher = std::function<void(const contact::ContactProblem& problem,
                                              std::span<const contact::Impulse> start)>;
    void watch_problems(ProblemWatcher watcher);

    /// Limits of the counted work of a step with fingers (contact/work.h): for all solves, about 12
    /// ms, and for the search for bodies that enter each other, about 3 ms. The minimum work of
    /// each solve comes on top of these limits.
    static constexpr int64_t kMostSolveWork = 400'000;
    static constexpr int64_t kMostSearchWork = 100'000;

    /// Steps by h [s].
    StepStatus step(double h) noexcept;
    /// Whether a step, or a set pose or velocity, left the world with values that are not
    /// numbers or are beyond kBeyond.
    bool diverged() const noexcept;
    /// To be called after divergence, between two steps: returns lost bodies to their poses in the
    /// scene, at rest, and forgets the contacts' impulses.
    void mend() noexcept;

  private:
    friend class Sabotage;  // plants faults within a step for the books to find (test)
    struct Impl;
    std::unique_ptr<Impl> impl_;
    std::vector<BodyState> states_;
    std::vector<contact::Contact> contacts_;
    contact::SolveStats stats_;
    Vec3 gravity_;
};

}  // namespace dihaptic::dynamics
