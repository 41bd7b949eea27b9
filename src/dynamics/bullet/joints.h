// The joints of a world: their equations become rows of the contact problem (contact/problem.h).
//
// A joint has a frame F on each of its two bodies. Each kind of joint keeps certain functions C_i
// of the relative pose of these frames at zero, and may have one coordinate q. The rows require
// that C_i = 0 at the end of the step. With v' a guess of the final velocities, and J the
// derivative of C at the start, this means
//
//     C(x moved by h v') + h J (v - v') = 0      bias = C(x moved by h v') / h - J v'
//
// which is linear in v, and exact once v' equals v: the step is solved repeatedly, each time
// starting from the last answer, until v' no longer changes. Impulses act along J at the start and
// constraints hold at the end: in a mechanism without contacts and springs this is the leapfrog
// method with constraints (SHAKE: Ryckaert, Ciccotti and Berendsen 1977), which is of second order,
// and symplectic, with velocities at the middle of a step.
//
// A spring's force is that of Newmark's method (1959) with numerical damping by its own stiffness:
// with u the speed of the coordinate, u' its speed before the step, and s = h^2 k / m,
//
//     f = -k (q + theta h (u - (1 - delta) u'))
//     delta = s / (1 + s),     theta = (1 + 3 delta) / 4
//
// A slow spring (s far below 1) keeps its energy; a stiff one on a light body is damped as by an
// implicit Euler step, so that it does not shake the hand. README.md has the closed form. Dampers
// and stops hold at the end of the step.
#pragma once

#include <BulletDynamics/Dynamics/btRigidBody.h>

#include <array>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "contact/problem.h"
#include "dynamics/books.h"
#include "dynamics/world.h"

namespace dihaptic::dynamics {

class Joints {
  public:
    /// One side of a joint. A body's pose is that of its mass frame; `fixed` bodies do not move.
    /// The world counts as a body too.
    struct Side {
        btRigidBody* body = nullptr;
        bool fixed = true;
        int item = -1;  ///< index in the world; -1 for the world itself
        size_t at() const noexcept { return static_cast<size_t>(item); }
    };
    void add(const scene::Joint& joint, const Side& a, const Side& b);

    size_t size() const noexcept { return joints_.size(); }
    /// Number of ProblemJoints needed for a problem with all joints.
    size_t elements() const noexcept { return kElements * joints_.size(); }
    const Side& a(size_t i) const noexcept { return joints_[i].a; }
    const Side& b(size_t i) const noexcept { return joints_[i].b; }
    std::span<const JointState> states() const noexcept { return states_; }

    /// Sets a joint's properties. Returns whether this changes anything.
    bool set(size_t i, const JointProperties& properties) noexcept;
    /// Drives a joint's motor in the coming step.
    void drive(size_t i, const Motor& motor) noexcept;
    bool is_driven(size_t i) const noexcept { return joints_[i].motor.has_value(); }
    /// Energy stored in a joint's springs at the start of the step [J].
    double stored(size_t i) const noexcept {
        return stored(joints_[i], 0, Vec3::Zero(), Vec3::Zero());
    }
    /// Effect of a unit force along the coordinate on the first and the second body: a force at the
    /// body's centre of mass, and a torque. Zero if the joint has no coordinate.
    std::pair<contact::Vec6, contact::Vec6> along(size_t i) const noexcept;

    /// Adds the rows of these joints to the problem. `index` maps each item to its body in the
    /// problem. The first guess of the velocities is from expected(). The initial impulses, which
    /// are somewhat smaller than those of the last step, are appended to `start`.
    void add_rows(std::span<const size_t> which, std::span<const int> index, double h,
                  contact::ContactProblem& problem, std::vector<Vec3>& start) noexcept;
    /// Updates the rows for a new guess in which velocities change by `change`, indexed by body in
    /// the problem. Returns the largest change in a bias [m/s], [rad/s].
    double guess(std::span<const size_t> which, std::span<const int> index, double h,
                 std::span<const contact::Vec6> change, contact::ContactProblem& problem) noexcept;
    /// Imposes the joints' equations only on the velocities, and corrects position errors. This is
    /// a first-order step, which adds no energy except through that correction.
    void hold(std::span<const size_t> which, double h, contact::ContactProblem& problem) noexcept;
    /// Stores the impulses of a step of h, and the velocity changes, indexed by body in the
    /// problem.
    void store(std::span<const size_t> which, std::span<const int> index,
               std::span<const contact::Vec6> change, std::span<const Vec3> impulses,
               double h) noexcept;
    /// Stops all motors until they are driven again.
    void end_step() noexcept;
    /// Reads the coordinates. To be called after a step, or after bodies were moved.
    void read() noexcept;
    /// The point where a joint's force acted on both bodies during the step: the position of the
    /// second body's point at the start of the step.
    const Vec3& acts_at(size_t i) const noexcept { return joints_[i].acts_at_W; }
    /// The exchange through a joint in a step of h during which its bodies move, at acts_at(), with
    /// the velocities in `meeting`.
    Books::Exchange exchange(size_t i, double h, const Books::Meeting& meeting) const noexcept;
    /// Forgets the impulses of the last step.
    void forget() noexcept;

  private:
    static constexpr size_t kElements = 3;  // linear rows, angular rows, and rows of the coordinate
    /// Changes in a body's velocities due to contacts and joints in the last steps.
    struct Change {
        contact::Vec6 now = contact::Vec6::Zero();
        contact::Vec6 last = contact::Vec6::Zero();
        contact::Vec6 before = contact::Vec6::Zero();
        contact::Vec6 next() const noexcept { return 2 * last - before; }
        void end_step() noexcept {
            before = last;
            last = now;
        }
    };
    /// The coordinate of a joint, and the functions of the relative pose of its frames that should
    /// be zero.
    struct Gaps {
        Vec3 linear = Vec3::Zero();
        Vec3 angular = Vec3::Zero();
        double q = 0;
    };
    struct Joint {
        scene::Joint spec;
        Side a;
        Side b;
        Pose X_AF;
        Pose X_BF;
        std::array<Vec3, kElements> impulses{Vec3::Zero(), Vec3::Zero(), Vec3::Zero()};
        Change change_a = {};
        Change change_b = {};
        std::array<contact::ProblemJoint, kElements> rows = {};
        std::array<int, kElements> row_at{-1, -1, -1};  // index in the problem; -1 if none
        double inverse_mass = 0;                        // inverse mass moved by the coordinate
        contact::Vec6 inverse_masses = contact::Vec6::Zero();  // of a bushing, one per axis
        contact::Vec6 rates = contact::Vec6::Zero();           // of a bushing, before the step
        JointProperties properties = {};
        std::optional<Motor> motor = {};      // command for this step
        std::optional<double> led_from = {};  // the motor's target in the previous step
        Gaps start = {};                      // values at the start of the step
        Vec3 acts_at_W = Vec3::Zero();
    };
    static Gaps gaps(const Joint& joint, const Pose& X_WA, const Pose& X_WB,
                     double q_near) noexcept;
    static void fill(const Joint& joint, const Pose& X_WA, const Pose& X_WB,
                     std::span<contact::ProblemJoint> rows) noexcept;
    static contact::Vec6 expected(const Side& side, const Change& change, double h) noexcept;
    /// Computes the rows for the guessed velocities. Returns the largest change in a bias.
    double ask(size_t i, double h, const contact::Vec6& v_a, const contact::Vec6& v_b) noexcept;
    double ask_of_coordinate(size_t i, double q, double q_now, double h,
                             contact::ProblemJoint& row) const noexcept;
    static double ask_of_stop(const scene::Joint& spec, double q, double q_now, double h, int k,
                              contact::ProblemJoint& row) noexcept;
    /// Copies a joint's rows to the problem.
    static void tell(const Joint& joint, contact::ContactProblem& problem) noexcept;
    /// Computes the rows of a bushing whose gaps would be `then` after a step at these velocities.
    static void ask_of_bushing(const Joint& joint, const Gaps& then, double h,
                               const contact::Vec6& v_a, const contact::Vec6& v_b,
                               std::span<contact::ProblemJoint> rows) noexcept;
    /// Energy in a joint's springs half a step after the start of the step if its bodies move at
    /// these velocities or, for a negative h, half a step before the start [J].
    static double stored(const Joint& joint, double h, const Vec3& v_W, const Vec3& w_W) noexcept;
    /// Computes the row of a motor or, if there is none, of dry friction.
    static void ask_of_motor(const Joint& joint, double q, double h, int k,
                             contact::ProblemJoint& row) noexcept;

    /// The direction of a slider's axis, or from the first to the second point of a distance joint.
    static Vec3 direction(const Joint& joint, const Pose& X_WA, const Pose& X_WB) noexcept;

    std::vector<Joint> joints_;
    std::vector<JointState> states_;
};

}  // namespace dihaptic::dynamics
