// World simulates rigid bodies under gravity, with contact and friction. One step consists of
//
//     v <- v + h (g + f/m),  w <- w + h I^-1 torque      apply all loads except contacts
//     find contacts; solve for contact impulses          velocities obey contact and friction
//     x <- x + h v,  R <- exp(h w) R                     semi-implicit Euler
//
// so that the friction of the solver responds to all loads of the step, including applied torques,
// which it would not see in Bullet's own order. Bodies at rest that touch no moving body sleep:
// they cost nothing and do not move at all (sleep.h).
//
// Set-up may allocate memory and throw exceptions; after activate(), steps do neither.
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
    Vec3 v_WB = Vec3::Zero();  ///< velocity of B's origin [m/s]
    Vec3 w_WB = Vec3::Zero();  ///< angular velocity [rad/s]
    bool awake = true;         ///< false if asleep or fixed: the state then does not change
};

/// State of a joint of the scene. A hinge or slider has a coordinate: the position of its second
/// body relative to the first, which is 0 at the start.
struct JointState {
    scene::JointKind kind = scene::JointKind::hinge;
    double position = 0;           ///< value of the coordinate [rad] or [m]
    double velocity = 0;           ///< rate of change of the coordinate [rad/s] or [m/s]
    Vec3 force_W = Vec3::Zero();   ///< force of the first body on the second, at the joint [N]
    Vec3 torque_W = Vec3::Zero();  ///< torque, including spring, friction and stops [N*m]
};

/// Factors by which a body's properties are multiplied. If the scene defines a surface for a pair
/// of bodies, only the friction factor applies to it.
struct BodyProperties {
    Vec3 mass = Vec3::Ones();  ///< for its inertia to motion along the world's axes
    double weight = 1;
    double turning = 1;      ///< for its moments of inertia
    double friction = 1;     ///< for its friction coefficients with all other bodies
    double stiffness = 1;    ///< for its own surface; the damping is scaled too
    double restitution = 1;  ///< for its own surface; restitution is limited to 1
    double texture_wavelength = 1;
    double texture_height = 1;    ///< for the height of its texture, see scene::Texture::scale()
    double texture_friction = 1;  ///< for the friction variation of its texture
    bool operator==(const BodyProperties&) const = default;
};

/// Factors by which a joint's properties are multiplied.
struct JointProperties {
    double stiffness = 1;
    double damping = 1;
    double friction = 1;  ///< dry
    bool operator==(const JointProperties&) const = default;
};

/// The action of a motor on a joint with a coordinate.
struct Motor {
    std::optional<double> position;  ///< target of the joint at the end of the step
    double most_force = 0;           ///< largest force for this motion [N] or [N*m]
    double push = 0;  ///< additional force exerted by the first body on the second [N] or [N*m]
};

/// The reasons why a step was incomplete.
enum class StepStatus : unsigned {
    ok = 0,
    contacts_full = 1u << 0,  ///< more contacts than reserved: memory was allocated, and contacts()
                              ///< is incomplete. Raise dynamics.max_contacts.
    diverged = 1u << 1,  ///< a position or speed is not a number, or is beyond kBeyond: steps do
                         ///< nothing until mend()
};

/// No object in an experiment is this far away or moves this fast: a free fall of half a day covers
/// 1e10 m. Beyond this limit, squares of squares overflow [m], [m/s], [rad/s].
constexpr double kBeyond = 1e12;

/// Maximum number of contacts of one point in a step.
constexpr size_t kMostPointContacts = 6;

using contact::Solver;
using Settings = frame::DynamicsSettings;

class World {
  public:
    /// Creates a world with all bodies of the scene at their initial poses.
    World(const scene::Scene& scene, const frame::DynamicsSettings& settings);
    ~World();
    World(World&&) noexcept;
    World& operator=(World&&) noexcept;

    /// Adds a finger's proxy at a position. Gravity does not act on it. If it turns, it turns about
    /// P, and its inertia about every axis is the mean of its moments about P.
    BodyIndex add_proxy(const scene::Finger& finger, const Vec3& p_WP, bool turns = false);
    /// Adds a proxy that set_point() can change to a point and back.
    BodyIndex add_changeable_proxy(const scene::Finger& finger, const Vec3& p_WP,
                                   bool turns = false);
    /// Adds a finger whose proxy is a point. The point has only those contacts that are added by
    /// meet().
    BodyIndex add_point(const scene::Finger& finger, const Vec3& p_WP, bool turns = false);
    /// Reserves all memory needed by steps.
    void activate();

    /// Turns a changeable proxy into a point or, if `point` is false, back into a body with its
    /// shape, from the next step on.
    void set_point(BodyIndex proxy, bool point) noexcept;

    int size() const;        ///< number of bodies, including proxies
    int scene_size() const;  ///< number of bodies of the scene; their indices are lower than this
    BodyIndex find(const std::string& name) const;
    const std::string& name(BodyIndex body) const;
    /// Coefficient of friction between two bodies, without their textures.
    double friction(BodyIndex a, BodyIndex b) const;
    /// Coefficient of friction including the textures of both bodies, where b touches a face of a
    /// with the normal n_W at p_W.
    double friction_at(BodyIndex a, BodyIndex b, const Vec3& p_W, const Vec3& n_W) const noexcept;
    /// The combined surface of two bodies, with the friction given in the scene.
    const scene::PairSurface& surface(BodyIndex a, BodyIndex b) const;

    /// States of all bodies after the last step.
    std::span<const BodyState> states() const { return states_; }
    const BodyState& state(BodyIndex body) const {
        return states_[static_cast<size_t>(body.value)];
    }
    /// Bodies that took part in the last step, and fixed bodies that were moved before it. All
    /// other bodies have stayed in place.
    std::span<const size_t> stepped() const;
    /// Contacts of the last step, except those of sleeping bodies.
    std::span<const contact::Contact> contacts() const { return contacts_; }
    /// Statistics of the last step, combined over its islands, which are solved one by one.
    const contact::SolveStats& solve_stats() const { return stats_; }
    /// The largest residual in the last step among the islands with a finger, or 0 if there are
    /// none.
    double held_residual() const noexcept;
    /// The balance of the last step.
    const Balance& balance() const noexcept;
    /// Whether a body moved less in the last step than its velocity implies, because it would have
    /// entered another body.
    bool held_back() const noexcept;
    /// States of the scene's recorded joints after the last step, in scene order.
    std::span<const JointState> joints() const noexcept;
    double mass(BodyIndex body) const;
    /// Inertia about P of a proxy that can turn [kg*m^2].
    double inertia(BodyIndex proxy) const;
    const Vec3& gravity() const { return gravity_; }

    /// Sets the mass of a body from the next step on [kg].
    void set_mass(BodyIndex body, double mass) noexcept;
    /// Sets the properties of a scene body from the next step on; the body wakes if they change.
    /// For a fixed body, only the friction has an effect, and all other bodies wake.
    void set_properties(BodyIndex body, const BodyProperties& properties) noexcept;
    /// Multiplies all coefficients of friction by `scale` from the next step on; all bodies wake.
    void set_friction_scale(double scale) noexcept;
    double friction_scale() const noexcept;
    /// Sets the velocity of the body's origin.
    void set_velocity(BodyIndex body, const Vec3& v_WB) noexcept;
    /// Sets the velocity of the body's origin, and the angular velocity, as far as its constraints
    /// allow. The body must not be fixed or driven.
    void set_motion(BodyIndex body, const Vec3& v_WB, const Vec3& w_WB) noexcept;
    /// For a proxy that can turn: sets its inertia about P [kg*m^2] or its angular velocity
    /// [rad/s].
    void set_inertia(BodyIndex proxy, double inertia) noexcept;
    void set_angular_velocity(BodyIndex proxy, const Vec3& w_WP) noexcept;
    /// Turns a proxy that cannot turn by itself: sets its orientation, and the angular velocity
    /// that it keeps despite contacts. The velocity of P is unchanged.
    void carry(BodyIndex proxy, const Quat& R_WP, const Vec3& w_WP) noexcept;
    /// Moves a body to another pose and sets its velocity to zero. If the body is fixed or asleep,
    /// all other bodies wake.
    void set_pose(BodyIndex body, const Pose& X_WB) noexcept;
    /// Moves a body that is not fixed to a pose during the next step, despite contacts; the body
    /// keeps the velocity that takes it there. A body declared as driven in the scene stays in
    /// place unless this is called.
    void drive(BodyIndex body, const Pose& X_WB) noexcept;
    /// Sets the properties of a joint from the next step on; its bodies wake if they change.
    void set_joint_properties(size_t joint, const JointProperties& properties) noexcept;
    /// Drives a joint in the next step. A motor with a target position overcomes the joint's dry
    /// friction by itself, and approaches the target no faster than half of its force could stop
    /// it.
    void drive_joint(size_t joint, const Motor& motor) noexcept;
    /// Adds a force at the centre of mass [N] and a torque [N*m] to the loads of the next step.
    void apply(BodyIndex body, const Vec3& force_W, const Vec3& torque_W) noexcept;
    /// Adds a force that acts at p_W [m] to the loads of the next step.
    void apply_at(BodyIndex body, const Vec3& force_W, const Vec3& p_W) noexcept;
    /// Sets the position and velocity of a point.
    void set_point(BodyIndex point, const Vec3& p_WP, const Vec3& v_WP) noexcept;
    /// A possible contact of a point in the next step with a face of a body, `gap` [m] away. The
    /// normal points out of the body at the point. Only a fraction of the pair's friction acts.
    struct PointContact {
        BodyIndex body;
        int part = 0;  ///< contacts with the same part and face start from its last impulse
        int face = 0;
        Vec3 n_W = Vec3::UnitZ();
        double gap = 0;
        double friction_share = 1;
        double compliance = 0;  ///< along the normal: speed at which the point yields per impulse
                                ///< [m/s per N*s]
    };
    /// Adds a contact of a point; at most kMostPointContacts in a step.
    void meet(BodyIndex point, const PointContact& contact) noexcept;

    /// Sets the solver to use from the next step on; it starts from the impulses of the last step.
    void set_solver(contact::Solver solver) noexcept;
    contact::Solver solver() const noexcept;

    /// A function called before each solve, with the problem and the initial impulses. Meant for
    /// benchmarks: the call is part of the step, so it must not throw.
    using ProblemWatcher = std::function<void(const contact::ContactProblem& problem,
                                              std::span<const contact::Impulse> start)>;
    void watch_problems(ProblemWatcher watcher);

    /// Limits on the counted work of a step with fingers (contact/work.h): about 12 ms for all
    /// solves, and about 3 ms for the search for bodies that enter each other. The minimum work of
    /// each solve is not subject to these limits.
    static constexpr int64_t kMostSolveWork = 400'000;
    static constexpr int64_t kMostSearchWork = 100'000;

    /// Simulates one step of h [s].
    StepStatus step(double h) noexcept;
    /// Whether a step, or a pose or velocity set from outside, left the world with values that are
    /// not numbers or are beyond kBeyond.
    bool diverged() const noexcept;
    /// To be called between two steps, after a divergence. Returns lost bodies to their poses in
    /// the scene, at rest, and forgets the impulses of all contacts.
    void mend() noexcept;

  private:
    friend class Sabotage;  // in a test: plants faults within a step for the books to find
    struct Impl;
    std::unique_ptr<Impl> impl_;
    std::vector<BodyState> states_;
    std::vector<contact::Contact> contacts_;
    contact::SolveStats stats_;
    Vec3 gravity_;
};

}  // namespace dihaptic::dynamics
