// The parts of a World. Only the sources of World include this file: world.cpp sets it up,
// world_step.cpp steps it, world_solve.cpp solves its islands, and world_books.cpp keeps its books.
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

/// An item that belongs to an island, which is a group of bodies that touch, directly or through
/// others that can move.
template <class T>
struct OfIsland {
    size_t island;  // order of islands: those with a finger first, then by lowest body
    int order;      // among items of its kind, for stable sorting without memory
    T item;
    bool operator<(const OfIsland& other) const {
        return island != other.island ? island < other.island : order < other.order;
    }
};

struct World::Impl {
    struct Item {
        std::string name;
        double friction = 0;
        scene::Surface surface;  // without its texture and place: a copy allocates nothing
        std::optional<scene::Texture> texture;  // as in the scene
        std::optional<scene::Texture> relief;   // as the properties change it

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
        bool is_driven = false;        // declared in the scene: only drive() moves it
        std::optional<Pose> drive_to;  // target of the coming step
        Pose X_BM;
        Vec3 inertia = Vec3::Zero();
        double mass = 0;
        Vec3 moves;  // 1 for each axis along which it can move, otherwise 0
        Vec3 turns;  // the same for axes about which it can turn
        BodyProperties properties;
        std::vector<std::unique_ptr<CollisionPart>> parts;
        std::unique_ptr<btRigidBody> body;
        Vec3 force = Vec3::Zero();
        Vec3 torque = Vec3::Zero();
        btVector3 v_last{0, 0, 0};  // before the step's loads
        btVector3 w_last{0, 0, 0};
        btVector3 w_start{0, 0, 0};   // after the loads
        btVector3 w_free{0, 0, 0};    // mean over the step without contacts and joints
        Vec3 L_W = Vec3::Zero();      // angular momentum about its centre of mass, after the step
        btVector3 v_before{0, 0, 0};  // before contacts acted
        btVector3 w_before{0, 0, 0};
        int stood = 0;                // steps for which it waited in place
        bool bounces = false;         // whether it bounces in this step
        btVector3 v_leaves{0, 0, 0};  // if so: velocities after the step
        btVector3 w_leaves{0, 0, 0};
        /// Whether the body follows its drive in this step, in spite of contacts.
        bool is_led() const { return is_driven || drive_to; }
        /// Whether the body's angular velocity can change at constant angular momentum. A proxy
        /// cannot, because it has the same inertia about all axes; nor can a body restricted to one
        /// axis.
        bool turns_freely() const { return !is_proxy && turns == Vec3::Ones() && !is_led(); }
    };

    scene::Scene scene;
    frame::DynamicsSettings settings;
    std::vector<Item> items;
    std::vector<size_t> awake;  // bodies that take part in the step
    std::vector<size_t> can_move;
    std::vector<size_t> placed;   // fixed bodies moved since the last step
    std::vector<size_t> stepped;  // bodies that took part in the last step or were placed before it
    std::vector<contact::Mat6> inverse_mass;  // of each body that is awake
    std::vector<contact::Vec6> by_loads;      // change of its velocities by the step's loads
    std::vector<OfIsland<btCollisionObject*>> bodies_of_islands;
    std::vector<OfIsland<btPersistentManifold*>> contacts_of_islands;
    std::vector<char> holds_finger;                 // by the body that represents an island
    std::vector<btCollisionObject*> island_bodies;  // of the island being solved
    std::vector<btPersistentManifold*> island_contacts;
    std::vector<scene::PairSurface> surfaces;  // by pair of bodies, row-major
    double friction_scale = 1;
    std::unique_ptr<Collision> collision;
    PointContacts point_contacts;
    Joints joints;
    size_t recorded_joints = 0;  // number of joints that are recorded, which come first
    std::vector<OfIsland<size_t>> joints_of_islands;
    std::vector<size_t> island_joints;
    std::vector<contact::Vec6> island_change;  // of velocities, by the problem's bodies
    CarriedPool carried_pool;
    std::unique_ptr<Groups> groups;
    std::unique_ptr<SleepKeeper> sleep;
    ManifoldProblem problem;
    contact::ContactSolvers solvers;
    ProblemWatcher watcher;
    bool diverged = false;
    bool held_back = false;  // whether any body was held back in the last step
    bool has_fingers = false;
    double held_residual = 0;  // largest over islands with a finger
    contact::Work work;        // work of the step's solves
    Books books;

    void add(const std::string& name, const scene::Shape& shape, double mass,
             double friction_coefficient, double torsion_radius, const Pose& X_WB,
             const Vec3& moves, const Vec3& turns, bool about_origin = false);
    /// A body's own surface, modified by its properties.
    scene::Surface surface_of(size_t i) const;
    /// Computes the combined surfaces of a body and all others.
    void pair_surfaces(size_t i);
    const scene::PairSurface& surface_of(size_t a, size_t b) const {
        return surfaces[a * items.size() + b];
    }
    /// The static coefficient of friction of a pair, including perturbations.
    double friction_of(size_t a, size_t b) const {
        return surface_of(a, b).friction * items[a].properties.friction *
               items[b].properties.friction * friction_scale;
    }
    /// A body's texture on a face with the normal n_W at p_W; flat without one. The
    /// slope is in W.
    scene::Relief relief_at(size_t i, const Vec3& p_W, const Vec3& n_W) const noexcept;
    void add(const scene::Joint& joint);
    /// Excludes contact between bodies of the same group.
    void part_groups();
    void reserve_bodies(size_t count);
    bool is_awake(size_t i) const { return items[i].body->getUserIndex2() == kAwake; }
    /// Whether a joint can move this side in the step.
    bool works(const Joints::Side& side) const { return !side.fixed && is_awake(side.at()); }
    void wake(size_t i, std::vector<BodyState>& states);
    void wake_sides(size_t joint, std::vector<BodyState>& states);
    /// Announces a fixed body's new pose to the bodies that rest on it, and to the search for
    /// contacts.
    void place_fixed(size_t i, std::vector<BodyState>& states);
    void collect_awake(std::vector<BodyState>& states);
    /// Wakes bodies joined to an awake body.
    void wake_joined(std::vector<BodyState>& states);
    /// Whether a body's position and velocity are numbers, and within kBeyond.
    bool is_sound(size_t i) const;
    bool all_sound() const;
    /// Inverse mass at the item's present orientation, without the motions that joints to the world
    /// prevent.
    contact::Mat6 inverse_mass_of(const Item& item) const;
    void note_stepped();
    void integrate_loads(double h, const Vec3& gravity);
    /// Gives a body the velocities that take it to its target in the step.
    void drive(Item& item, double h);
    void update_bounds(double h);
    /// Gives new contacts the properties of their pair's surfaces, and their Carried records.
    void prepare_contacts(std::span<btPersistentManifold* const> manifolds, double h);
    /// Adds the contacts of points to those found.
    void take_points(double h);
    bool has_texture(const btPersistentManifold& manifold) const;
    /// Changes the friction of contacts on textured surfaces according to their position, and sets
    /// the height and slope of the surfaces there.
    void let_feel(btPersistentManifold& manifold) const;
    /// Changes the friction of sliding contacts according to their surfaces, by the speeds and
    /// forces of the last step.
    void let_slide(btPersistentManifold& manifold, double h) const;
    /// Gives the points of a manifold their Carried records.
    void give_to(const btPersistentManifold& manifold);
    void find_islands();
    /// Forms groups of bodies that touch or that joints connect.
    void join_groups();
    /// Number of islands with a touching finger.
    int64_t held_islands() const;
    /// Solves island by island.
    contact::SolveStats solve(double h);
    contact::SolveStats solve_with_entered(double h, const Vec3& gravity,
                                           std::vector<BodyState>& states);
    /// Widens the bounds of bodies whose velocities were changed much by contacts.
    void widen_bounds(double h);
    /// Makes bodies that would still enter others wait in front of them.
    void hold_back(double h, contact::Work& search);
    /// If one body of a joint waits, makes the other wait too, since the joint would tear
    /// otherwise. False if nothing changed.
    bool wait_together();
    contact::SolveStats solve_island(double h, bool held);
    /// Solves the island again for the velocities after the step, if a body bounces.
    void let_bounce(const contact::SolveSettings& how, double h, contact::SolveStats& stats);
    /// Velocity and angular velocity of a body after the step's loads, before contacts and joints
    /// act.
    contact::Vec6 velocity_before(size_t i) const;
    /// Twice the kinetic energy that the island's bodies may have after the step [J]: their energy
    /// before, the energy that loads of this step and the next may add while a contact waits, and
    /// the energy in springs of joints and soft surfaces. Unbounded if a body or a joint is driven,
    /// which supplies any energy, or if a soft fingertip presses.
    double most_energy() const;
    /// Slows the island's bodies down if a missed answer would give them energy.
    void forbid_gain();
    /// Fraction of the way from the first answer, without bounces, to the answer with
    /// bounces that the island takes: 1, unless this would give it energy. Newton's law treats
    /// each contact by itself, so with friction and joints this is possible (Kane and Levinson
    /// 1985).
    double share_of_bounce() const;
    contact::Solver solver_of_island() const;
    /// Solves the island's problem, and repeats this as long as the rows of its joints change with
    /// the guessed velocities at the end of the step.
    contact::SolveStats solve_guessing(const contact::SolveSettings& how, double h);
    /// Angular momentum about the centre of mass, in W, at this angular velocity.
    static Vec3 momentum(const Item& item, const Vec3& w_W);
    /// Momentum, and angular momentum, at this velocity and angular velocity.
    static contact::Vec6 momentum(const Item& item, const contact::Vec6& v_W);
    /// Mean angular velocity of a free step from w_start (free_turn.h).
    static Vec3 mean_velocity(const Item& item, const Vec3& w_start, double h);
    /// Recomputes the rotation of the island's bodies if contacts and joints change their
    /// velocities by island_change at the start of the step. Returns the change of the guess
    /// [rad/s].
    double guess_turns(double h);
    void integrate_positions(double h);
    /// Gives bodies the angular velocities that follow from their momentum at their new
    /// orientation.
    void turn_on(std::vector<BodyState>& states);
    void read_state(size_t i, BodyState& state) const;
    void let_sleep(double h, std::vector<BodyState>& states);

    static Books::Motion motion_of(const Item& item);
    static Books::Body account_of(const Item& item, const Vec3& gravity);
    /// Opens the books of all awake bodies, a second time for those that woke late in the step.
    void open_books(const Vec3& gravity, bool late);
    void close_books();
    /// Lists the contacts of the step and enters each in the books. False without room for
    /// all.
    bool publish_contacts(double h, std::vector<contact::Contact>& out);
    void take(const contact::Contact& contact, const btManifoldPoint& point, double h);
    void take_joints(double h);
    /// Change, by the step's loads, of the speed at which a contact's bodies separate, times the
    /// contact's force [W].
    double loads_at(const contact::Contact& contact, const btManifoldPoint& point) const;
};

/// User indices of a manifold's two bodies.
inline std::pair<size_t, size_t> bodies_of(const btPersistentManifold& manifold) {
    return {static_cast<size_t>(manifold.getBody0()->getUserIndex()),
            static_cast<size_t>(manifold.getBody1()->getUserIndex())};
}

/// Beyond an eighth of a turn in a step, a body's orientation no longer follows from its angular
/// velocity, so the body is slowed to this.
inline Vec3 limited(const Vec3& w, double h) {
    const double most = std::numbers::pi / (4 * h);
    return w.squaredNorm() > most * most ? Vec3(w * (most / w.norm())) : w;
}

inline void limit_turn(btRigidBody& body, double h) {
    body.setAngularVelocity(to_bullet(limited(from_bullet(body.getAngularVelocity()), h)));
}

}  // namespace dihaptic::dynamics
