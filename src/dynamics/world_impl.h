// The implementation of World. Only the source files of World include this header: world.cpp sets
// it up, world_step.cpp steps it, world_solve.cpp solves its islands, and world_books.cpp audits
// its steps.
#pragma once

#include <btBulletDynamicsCommon.h>

#include <numbers>
#include <utility>

#include "contact/solver.h"
#include "dynamics/books.h"
#include "dynamics/bullet/carried.h"
#include "dynamics/bullet/collision.h"
#include "dynamics/bullet/joints.h"
#include "dynamics/bullet/point_contacts.h"
#include "dynamics/bullet/problem.h"
#include "dynamics/bullet/shape.h"
#include "dynamics/groups.h"
#include "dynamics/sleep.h"
#include "dynamics/world.h"

namespace dihaptic::dynamics {

/// An item that belongs to an island, i.e. a group of bodies that touch, directly or through other
/// movable bodies.
template <class T>
struct OfIsland {
    size_t island;  // order of islands: those with a finger first, then by lowest body index
    int order;      // order among items of its kind; allows stable sorting without allocating
    T item;
    bool operator<(const OfIsland& other) const {
        return island != other.island ? island < other.island : order < other.order;
    }
};

struct World::Impl {
    struct Item {
        std::string name;
        double friction = 0;
        scene::Surface surface;  // without texture and place: a copy does not allocate
        std::optional<scene::Texture> texture;  // texture given in the scene
        std::optional<scene::Texture> relief;   // texture modified by the body's properties

        void set_surface(const scene::Surface& given) {
            surface = given;
            surface.texture.reset();
            surface.place = {};
            texture = relief = given.texture;
        }
        double torsion_radius = 0;
        bool is_proxy = false;
        bool is_point = false;
        bool may_be_point = false;  // if so, its parts are hidden while it is a point
        bool can_move = false;
        bool is_driven = false;        // declared as driven in the scene: moved only by drive()
        std::optional<Pose> drive_to;  // target pose of the coming step
        Pose X_BM;
        Vec3 inertia = Vec3::Zero();
        double mass = 0;
        Vec3 moves;  // 1 for each axis along which it can move, otherwise 0
        Vec3 turns;  // 1 for each axis about which it can turn, otherwise 0
        BodyProperties properties;
        std::vector<std::unique_ptr<CollisionPart>> parts;
        std::unique_ptr<btRigidBody> body;
        Vec3 force = Vec3::Zero();
        Vec3 torque = Vec3::Zero();
        btVector3 v_last{0, 0, 0};  // before the loads of the step
        btVector3 w_last{0, 0, 0};
        btVector3 w_start{0, 0, 0};   // after the loads of the step
        btVector3 w_free{0, 0, 0};    // mean over the step in the absence of contacts and joints
        Vec3 L_W = Vec3::Zero();      // angular momentum about the centre of mass after the step
        btVector3 v_before{0, 0, 0};  // before the action of contacts
        btVector3 w_before{0, 0, 0};
        int stood = 0;                // number of steps for which it has waited in place
        bool bounces = false;         // whether it bounces in this step
        btVector3 v_leaves{0, 0, 0};  // velocity after the step, if it bounces
        btVector3 w_leaves{0, 0, 0};
        /// Whether the body follows its drive in this step, despite contacts.
        bool is_led() const { return is_driven || drive_to; }
        /// Whether the body's angular velocity can change while its angular momentum is constant.
        /// This is impossible for a proxy, which has the same inertia about all axes, and for a
        /// body restricted to one axis.
        bool turns_freely() const { return !is_proxy && turns == Vec3::Ones() && !is_led(); }
    };

    scene::Scene scene;
    frame::DynamicsSettings settings;
    std::vector<Item> items;
    std::vector<size_t> awake;  // bodies that take part in the step
    std::vector<size_t> can_move;
    std::vector<size_t> placed;   // fixed bodies that were moved since the last step
    std::vector<size_t> stepped;  // bodies that took part in the last step or were placed before it
    std::vector<contact::Mat6> inverse_mass;  // inverse mass of each awake body
    std::vector<contact::Vec6> by_loads;      // velocity change due to the step's loads
    std::vector<OfIsland<btCollisionObject*>> bodies_of_islands;
    std::vector<OfIsland<btPersistentManifold*>> contacts_of_islands;
    std::vector<char> holds_finger;                 // indexed by the body that represents an island
    std::vector<btCollisionObject*> island_bodies;  // bodies of the island being solved
    std::vector<btPersistentManifold*> island_contacts;
    std::vector<scene::PairSurface> surfaces;  // one per pair of bodies, row-major
    double friction_scale = 1;
    std::unique_ptr<Collision> collision;
    PointContacts point_contacts;
    Joints joints;
    size_t recorded_joints = 0;  // number of recorded joints, which come first
    std::vector<OfIsland<size_t>> joints_of_islands;
    std::vector<size_t> island_joints;
    std::vector<contact::Vec6> island_change;  // velocity changes of the problem's bodies
    CarriedPool carried_pool;
    std::unique_ptr<Groups> groups;
    std::unique_ptr<SleepKeeper> sleep;
    ManifoldProblem problem;
    contact::ContactSolvers solvers;
    ProblemWatcher watcher;
    bool diverged = false;
    bool held_back = false;  // whether any body was held back in the last step
    bool has_fingers = false;
    double held_residual = 0;  // largest residual among islands with a finger
    contact::Work work;        // work done by the solves of the step
    Books books;

    void add(const std::string& name, const scene::Shape& shape, double mass,
             double friction_coefficient, double torsion_radius, const Pose& X_WB,
             const Vec3& moves, const Vec3& turns, bool about_origin = false);
    /// The surface of a body, as modified by its properties.
    scene::Surface surface_of(size_t i) const;
    /// Computes the combined surfaces of a body with each other body.
    void pair_surfaces(size_t i);
    const scene::PairSurface& surface_of(size_t a, size_t b) const {
        return surfaces[a * items.size() + b];
    }
    /// The static coefficient of friction of a pair of bodies, including perturbations.
    double friction_of(size_t a, size_t b) const {
        return surface_of(a, b).friction * items[a].properties.friction *
               items[b].properties.friction * friction_scale;
    }
    /// The texture of a body on a face with the normal n_W at p_W; flat if it has no texture. The
    /// slope is in W.
    scene::Relief relief_at(size_t i, const Vec3& p_W, const Vec3& n_W) const noexcept;
    void add(const scene::Joint& joint);
    /// Excludes contact between bodies that belong to the same group.
    void part_groups();
    void reserve_bodies(size_t count);
    bool is_awake(size_t i) const { return items[i].body->getUserIndex2() == kAwake; }
    /// Whether a joint can move the body on this side in the step.
    bool works(const Joints::Side& side) const { return !side.fixed && is_awake(side.at()); }
    void wake(size_t i, std::vector<BodyState>& states);
    void wake_sides(size_t joint, std::vector<BodyState>& states);
    /// Passes the new pose of a fixed body on to the bodies that rest on it, and to the contact
    /// search.
    void place_fixed(size_t i, std::vector<BodyState>& states);
    void collect_awake(std::vector<BodyState>& states);
    /// Wakes bodies that are joined to an awake body.
    void wake_joined(std::vector<BodyState>& states);
    /// Whether a body's position and velocity are numbers and within kBeyond.
    bool is_sound(size_t i) const;
    bool all_sound() const;
    /// Inverse mass of an item in its current orientation, without the motions that joints to the
    /// world prevent.
    contact::Mat6 inverse_mass_of(const Item& item) const;
    void note_stepped();
    void integrate_loads(double h, const Vec3& gravity);
    /// Gives a body the velocities with which it reaches its target in the step.
    void drive(Item& item, double h);
    void update_bounds(double h);
    /// Gives new contacts the surface properties of their pair of bodies, and their Carried
    /// records.
    void prepare_contacts(std::span<btPersistentManifold* const> manifolds, double h);
    /// Adds the contacts of points to those found by collision detection.
    void take_points(double h);
    bool has_texture(const btPersistentManifold& manifold) const;
    /// Adapts the friction of contacts on textured surfaces to their position, and sets the height
    /// and slope of the surfaces at the contacts.
    void let_feel(btPersistentManifold& manifold) const;
    /// Adapts the friction of sliding contacts to their surfaces, based on the speeds and forces of
    /// the last step.
    void let_slide(btPersistentManifold& manifold, double h) const;
    /// Assigns Carried records to the points of a manifold.
    void give_to(const btPersistentManifold& manifold);
    void find_islands();
    /// Groups bodies that touch or that are connected by joints.
    void join_groups();
    /// Number of islands touched by a finger.
    int64_t held_islands() const;
    /// Solves the islands one by one.
    contact::SolveStats solve(double h);
    contact::SolveStats solve_with_entered(double h, const Vec3& gravity,
                                           std::vector<BodyState>& states);
    /// Widens the bounds of bodies whose velocities contacts changed considerably.
    void widen_bounds(double h);
    /// Makes bodies that would still enter others wait in front of those.
    void hold_back(double h, contact::Work& search);
    /// If one body of a joint waits, makes the other wait too, because the joint would tear
    /// otherwise. Returns false if nothing changed.
    bool wait_together();
    /// Number of visits for the solve of the island in `problem`.
    int most_work(bool held);
    /// Whether the island in `problem`, which no finger touches, is too large to be solved exactly
    /// in a tick. Such an island is solved once, and its contacts may be carried along.
    bool is_heap(const contact::SolveStats& stats);
    /// Share of a penetration that a step undoes in the island being solved: less in a heap that no
    /// finger touches.
    double recovery_of_island(bool held) const;
    contact::SolveStats solve_island(double h, bool held);
    /// If a body bounces, solves the island again for the velocities after the step.
    void let_bounce(const contact::SolveSettings& how, double h, contact::SolveStats& stats);
    /// Linear and angular velocity of a body after the loads of the step, before contacts and
    /// joints act.
    contact::Vec6 velocity_before(size_t i) const;
    /// Twice the kinetic energy that the island's bodies may have after the step [J]: the sum of
    /// their energy before the step, the energy that the loads of this step and the next may add
    /// while a contact waits, and the energy in the springs of joints and soft surfaces. Infinite
    /// if a body or a joint is driven, which supplies any energy, or if a soft fingertip presses.
    double most_energy() const;
    /// Slows down the island's bodies if an answer that misses the tolerance would give them
    /// energy.
    void forbid_gain();
    /// Fraction of the way from the first answer (without bounces) to the answer with bounces that
    /// the island moves: 1, unless this would give it energy. That can happen with friction and
    /// joints, since Newton's law treats each contact separately (Kane and Levinson 1985).
    double share_of_bounce() const;
    contact::Solver solver_of_island() const;
    /// Solves the island's problem, and repeats the solve as long as the rows of its joints change
    /// with the velocities guessed for the end of the step.
    contact::SolveStats solve_guessing(const contact::SolveSettings& how, double h);
    /// Angular momentum about the centre of mass, in W, for this angular velocity.
    static Vec3 momentum(const Item& item, const Vec3& w_W);
    /// Linear and angular momentum for these linear and angular velocities.
    static contact::Vec6 momentum(const Item& item, const contact::Vec6& v_W);
    /// Mean angular velocity of a free step that starts at w_start (free_turn.h).
    static Vec3 mean_velocity(const Item& item, const Vec3& w_start, double h);
    /// Recomputes the rotation of the island's bodies, given that contacts and joints change their
    /// velocities by island_change at the start of the step. Returns the change in the guess
    /// [rad/s].
    double guess_turns(double h);
    void integrate_positions(double h);
    /// Gives the bodies the angular velocities that result from their momentum in their new
    /// orientation.
    void turn_on(std::vector<BodyState>& states);
    void read_state(size_t i, BodyState& state) const;
    void let_sleep(double h, std::vector<BodyState>& states);

    static Books::Motion motion_of(const Item& item);
    static Books::Body account_of(const Item& item, const Vec3& gravity);
    /// Opens the books of all awake bodies or, if `late`, of those that woke late in the step.
    void open_books(const Vec3& gravity, bool late);
    void close_books();
    /// Lists the contacts of the step and enters each of them in the books. Returns false if there
    /// is no room for all of them.
    bool publish_contacts(double h, std::vector<contact::Contact>& out);
    void take(const contact::Contact& contact, const btManifoldPoint& point, double h);
    /// Energy that a contact gives back where it undoes a penetration: at most what it took while
    /// the bodies entered each other, since the answer was not exact. `speed` is that at which they
    /// separate [J].
    static double returned(Carried& contact, double gap, double normal, double speed, double h);
    void take_joints(double h);
    /// Change, due to the loads of the step, in the speed at which a contact's bodies separate,
    /// multiplied by the contact force [W].
    double loads_at(const contact::Contact& contact, const btManifoldPoint& point) const;
};

/// User indices of a manifold's two bodies.
inline std::pair<size_t, size_t> bodies_of(const btPersistentManifold& manifold) {
    return {static_cast<size_t>(manifold.getBody0()->getUserIndex()),
            static_cast<size_t>(manifold.getBody1()->getUserIndex())};
}

/// Limits an angular velocity to an eighth of a turn per step. Beyond this, a body's orientation
/// would no longer follow from its angular velocity.
inline Vec3 limited(const Vec3& w, double h) {
    const double most = std::numbers::pi / (4 * h);
    return w.squaredNorm() > most * most ? Vec3(w * (most / w.norm())) : w;
}

inline void limit_turn(btRigidBody& body, double h) {
    body.setAngularVelocity(to_bullet(limited(from_bullet(body.getAngularVelocity()), h)));
}

}  // namespace dihaptic::dynamics
