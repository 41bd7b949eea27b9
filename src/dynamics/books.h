// Books audits a step: it compares the changes of the bodies' momentum and energy with the impulses
// and work on them. It uses the published results of a step (motions, contacts, joint forces), the
// masses of the scene and the requested loads, and shares no computation with the solvers, so a
// fault in either becomes visible.
//
// Velocities are those of the middle of a step (README.md), half a step before the positions. The
// work of an impulse J on a point therefore follows from the mean of the point's velocities before
// and after it,
//
//     W = J . (u- + u+) / 2
//
// and the sum over all impulses on a body is exactly the change of its kinetic energy. The
// potential energy of a weight is taken at the body's position half a step ago, -m g . (x - h v /
// 2), so that a free fall exchanges it for kinetic energy to the last digit. A freely turning body
// keeps its angular momentum L after the impulses (free_turn.h), which act at the pose at
// the start of the step, where the body then has w = I^-1 L.
#pragma once

#include <vector>

#include "base/geometry.h"
#include "dynamics/balance.h"

namespace dihaptic::dynamics {

class Books {
  public:
    /// The motion of a body's centre of mass and of its principal axes M.
    struct Motion {
        Vec3 p_WM = Vec3::Zero();
        Mat3 R_WM = Mat3::Identity();
        Vec3 v_W = Vec3::Zero();
        Vec3 w_W = Vec3::Zero();
    };
    struct Body {
        Vec3 masses = Vec3::Zero();    ///< along the world's axes [kg]
        Vec3 moments = Vec3::Zero();   ///< about M's axes [kg*m^2]
        Vec3 weight_W = Vec3::Zero();  ///< [N]
        Vec3 moves = Vec3::Ones();     ///< 1 for each axis along which it can move, otherwise 0
        Vec3 turns = Vec3::Ones();     ///< the same for axes about which it can turn
        /// Whether its motion is prescribed, as for fingers and driven bodies; its energy is then
        /// not counted, and its effect on others is work.
        bool is_outside = false;
        bool is_led = false;  ///< whether its velocities are not due to impulses
    };

    void reserve(size_t bodies, size_t joints);

    /// Starts the account of a step of h [s].
    void begin(double h) noexcept;
    bool is_open(size_t body) const noexcept { return entries_[body].open; }
    /// To be called before the step changes a body's velocities. The load, without the weight, acts
    /// at its centre of mass. A body that is `late` woke up after loads had acted, so none acts on
    /// it.
    void open(size_t body, const Body& what, const Motion& before, const Wrench& load_W,
              bool late) noexcept;
    /// To be called after the step. A bouncing body moved at velocities other than those with which
    /// it leaves.
    void close(size_t body, const Motion& after, bool bounced) noexcept;

    /// An impulse on b at p_W, and a moment, with the opposite ones on a. A body that is not open,
    /// or -1, does not move.
    struct Exchange {
        int a = -1;
        int b = -1;
        Vec3 p_W = Vec3::Zero();
        Vec3 impulse_W = Vec3::Zero();  ///< [N*s]
        Vec3 moment_W = Vec3::Zero();   ///< [N*m*s]
        double given = 0;               ///< work of its motor [J]
        double stored_before = 0;       ///< in its springs [J]
        double stored_after = 0;
        double found = 0;  ///< impossible work, since a contact gives no energy [J]
        /// Index of its joint, whose springs may owe energy from one step to the next; -1 for a
        /// contact.
        int joint = -1;
    };
    /// Velocity of b relative to a at a point: after the impulses, and the mean of the velocities
    /// before and after them.
    struct Meeting {
        Vec3 v_mean = Vec3::Zero();
        Vec3 w_mean = Vec3::Zero();
        Vec3 v_after = Vec3::Zero();
        Vec3 w_after = Vec3::Zero();
        Vec3 v_before() const { return 2 * v_mean - v_after; }
        Vec3 w_before() const { return 2 * w_mean - w_after; }
    };
    /// To be called, like all functions below, once all bodies are closed.
    Meeting meet(int a, int b, const Vec3& p_W) const noexcept;
    /// Displacement in the step of b's point, initially at p_W, relative to a's.
    Vec3 way(int a, int b, const Vec3& p_W) const noexcept;
    /// Checks a contact of rigid surfaces that were `gap` apart along n_W, from a to b, at the
    /// start of the step, and notes if they penetrate each other nevertheless.
    void check_gap(const Exchange& exchange, const Meeting& meeting, const Vec3& n_W,
                   double gap) noexcept;
    void take(const Exchange& exchange, const Meeting& meeting) noexcept;

    /// To be called once all entries are made.
    void balance() noexcept;
    const Balance& last() const noexcept { return balance_; }
    /// A body fell asleep: its remaining energy is lost.
    void rest(size_t body) noexcept;
    /// Forgets the past, as after a divergence.
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
        Vec3 moment_W = Vec3::Zero();  ///< about its initial centre of mass
        double size = 0;               ///< sum of the components of all impulses [N*s]
        double turning_size = 0;       ///< likewise, of all moments [N*m*s]
        double kinetic = 0;            ///< after its last step
        double potential = 0;
    };
    const Entry* entry(int body) const noexcept;
    /// An impulse on a body, and a moment.
    static void act(Entry& one, const Vec3& p_W, const Vec3& impulse_W,
                    const Vec3& moment_W) noexcept;
    /// The unexplained part of the energy that a contact or joint releases, given its earlier debt.
    static double owe(double& owed, double passive) noexcept;
    void check_momentum(const Entry& one) noexcept;
    /// Whether a body's rotation agrees with its angular velocity.
    void check_turn(const Entry& one) noexcept;
    void count_energy(Entry& one) noexcept;
    void judge() noexcept;

    std::vector<Entry> entries_;
    std::vector<size_t> open_;
    std::vector<double> owed_;  // by joint, with a memory of kMemory [J]
    double h_ = 0;
    bool has_last_ = false;
    double before_ = 0;        // energy of the open bodies at the start of the step
    double last_energy_ = 0;   // of the same bodies, and all springs, after the previous step
    double springs_ = 0;       // after the step
    double last_springs_ = 0;  // after the previous step
    double gains_ = 0;         // in the step, by contacts and joints
    double by_contacts_ = 0;   // energy released by all contacts together in the step
    double owed_by_contacts_ = 0;
    double found_ = 0;      // unexplained, with a memory of kMemory
    double exchanged_ = 0;  // all work, likewise
    Balance balance_;
};

}  // namespace dihaptic::dynamics
