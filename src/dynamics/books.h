// Books audits a step: it compares the changes in the bodies' momentum and energy with the impulses
// and work applied to them. It uses the published results of a step (motions, contacts, joint
// forces), the masses of the scene and the requested loads, and shares no computation with the
// solvers, so a fault in either becomes visible.
//
// Velocities are those in the middle of a step (README.md), half a step before the positions. The
// work of an impulse J on a point therefore follows from the mean of the point's velocities before
// and after it,
//
//     W = J . (u- + u+) / 2
//
// and the sum over all impulses on a body is exactly the change in its kinetic energy. The
// potential energy of a weight is evaluated at the body's position half a step ago, -m g . (x - h v
// / 2), so that a free fall exchanges it for kinetic energy to the last digit. A freely turning
// body keeps its angular momentum L after the impulses (free_turn.h), which act at the pose at the
// start of the step, where the body then has w = I^-1 L.
#pragma once

#include <vector>

#include "base/geometry.h"
#include "dynamics/balance.h"

namespace dihaptic::dynamics {

class Books {
  public:
    /// The motion of a body's centre of mass and principal frame M.
    struct Motion {
        Vec3 p_WM = Vec3::Zero();
        Mat3 R_WM = Mat3::Identity();
        Vec3 v_W = Vec3::Zero();
        Vec3 w_W = Vec3::Zero();
    };
    struct Body {
        Vec3 masses = Vec3::Zero();    ///< effective masses along the world's axes [kg]
        Vec3 moments = Vec3::Zero();   ///< moments of inertia about M's axes [kg*m^2]
        Vec3 weight_W = Vec3::Zero();  ///< [N]
        Vec3 moves = Vec3::Ones();     ///< 1 for each axis along which the body can move, else 0
        Vec3 turns = Vec3::Ones();     ///< 1 for each axis about which the body can turn, else 0
        /// Whether the body's motion is prescribed, as for fingers and driven bodies. The energy of
        /// such a body is not counted, and its effect on other bodies is work.
        bool is_outside = false;
        bool is_led = false;  ///< whether the body's velocities are not the result of impulses
    };

    void reserve(size_t bodies, size_t joints);

    /// Starts the audit of a step of h [s].
    void begin(double h) noexcept;
    bool is_open(size_t body) const noexcept { return entries_[body].open; }
    /// To be called before the step changes a body's velocities. The load, which does not include
    /// the weight, acts at the centre of mass. A body that is `late` woke up after the loads had
    /// been applied, so none acts on it.
    void open(size_t body, const Body& what, const Motion& before, const Wrench& load_W,
              bool late) noexcept;
    /// To be called after the step. A body that bounced moved during the step at velocities other
    /// than those with which it leaves.
    void close(size_t body, const Motion& after, bool bounced) noexcept;

    /// An impulse on b at p_W, and a moment; the opposite impulse and moment act on a. A body whose
    /// index is -1, or that is not open, does not move.
    struct Exchange {
        int a = -1;
        int b = -1;
        Vec3 p_W = Vec3::Zero();
        Vec3 apart_W = Vec3::Zero();    ///< from a's point to b's, with p_W in the middle
        Vec3 impulse_W = Vec3::Zero();  ///< [N*s]
        Vec3 moment_W = Vec3::Zero();   ///< [N*m*s]
        double given = 0;               ///< work done by the joint's motor [J]
        double stored_before = 0;       ///< energy in the joint's or contact's springs [J]
        double stored_after = 0;
        double found = 0;  ///< excess energy released by a contact, which should be zero [J]
        /// Index of the joint, whose springs may owe energy from one step to the next; -1 for a
        /// contact.
        int joint = -1;

        Vec3 point_of_a() const { return p_W - apart_W / 2; }
        Vec3 point_of_b() const { return p_W + apart_W / 2; }
    };
    /// Velocities of b relative to a at a point: the velocity after the impulses, and the mean of
    /// the velocities before and after them.
    struct Meeting {
        Vec3 v_mean = Vec3::Zero();
        Vec3 w_mean = Vec3::Zero();
        Vec3 v_after = Vec3::Zero();
        Vec3 w_after = Vec3::Zero();
        Vec3 v_before() const { return 2 * v_mean - v_after; }
        Vec3 w_before() const { return 2 * w_mean - w_after; }
    };
    /// To be called, like all functions below, once all bodies have been closed.
    Meeting meet(const Exchange& exchange) const noexcept;
    /// Displacement during the step of the point of b at which the impulse acts, relative to the
    /// corresponding point of a.
    Vec3 way(const Exchange& exchange) const noexcept;
    /// Checks a contact between rigid surfaces that were `gap` apart along n_W (from a to b) at the
    /// start of the step. Notes an imbalance if the surfaces nevertheless penetrate each other.
    void check_gap(const Exchange& exchange, const Meeting& meeting, const Vec3& n_W,
                   double gap) noexcept;
    void take(const Exchange& exchange, const Meeting& meeting) noexcept;

    /// Computes the balance. To be called once all exchanges have been entered.
    void balance() noexcept;
    const Balance& last() const noexcept { return balance_; }
    /// Notes that a body fell asleep, so that its remaining energy is lost.
    void rest(size_t body) noexcept;
    /// Forgets all previous steps, e.g. after a divergence.
    void forget() noexcept;

  private:
    struct Entry {
        bool open = false;
        bool late = false;
        bool bounced = false;
        Body body;
        Motion before;
        Motion after;
        Wrench load_W;
        Vec3 L_before_W = Vec3::Zero();
        Vec3 L_after_W = Vec3::Zero();
        Vec3 w_struck_W = Vec3::Zero();  ///< after the impulses, before further rotation
        Vec3 v_mean_W = Vec3::Zero();
        Vec3 w_mean_W = Vec3::Zero();
        Vec3 impulse_W = Vec3::Zero();
        Vec3 moment_W = Vec3::Zero();  ///< about the initial centre of mass
        double size = 0;               ///< sum of the absolute components of all impulses [N*s]
        double turning_size = 0;       ///< the same for all moments [N*m*s]
        double kinetic = 0;            ///< kinetic energy after the body's last step
        double potential = 0;
    };
    const Entry* entry(int body) const noexcept;
    /// Adds an impulse and a moment that act on a body.
    static void act(Entry& one, const Vec3& p_W, const Vec3& impulse_W,
                    const Vec3& moment_W) noexcept;
    /// Returns the unexplained part of the energy that a contact or joint releases, given its
    /// earlier debt.
    static double owe(double& owed, double passive) noexcept;
    void check_momentum(const Entry& one) noexcept;
    /// Checks whether a body's rotation agrees with its angular velocity.
    void check_turn(const Entry& one) noexcept;
    void count_energy(Entry& one) noexcept;
    void judge() noexcept;

    std::vector<Entry> entries_;
    std::vector<size_t> open_;
    std::vector<double> owed_;  // energy owed by each joint, with a memory of kMemory [J]
    double h_ = 0;
    bool has_last_ = false;
    double before_ = 0;        // energy of the open bodies at the start of the step
    double last_energy_ = 0;   // energy of these bodies and all springs after the previous step
    double springs_ = 0;       // energy of springs after the step
    double last_springs_ = 0;  // energy of springs after the previous step
    double gains_ = 0;         // unexplained gains of contacts and joints in this step
    double by_contacts_ = 0;   // energy released by all contacts together in the step
    double owed_by_contacts_ = 0;
    double found_ = 0;      // unexplained energy, with a memory of kMemory
    double exchanged_ = 0;  // all work exchanged, with the same memory
    Balance balance_;
};

}  // namespace dihaptic::dynamics
