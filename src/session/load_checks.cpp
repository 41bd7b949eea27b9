#include "session/load_checks.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <set>

#include "model/grasp.h"
#include "task/run/trial_numbers.h"

namespace dihaptic::session {
namespace {

constexpr double kFastReach = 0.5;  // speed of a fast reach [m/s]

/// Checks the loads in all conditions; reports each fault only once.
class LoadChecks {
  public:
    LoadChecks(const Plan& plan, Diagnostics& diagnostics)
        : plan_(plan), diagnostics_(diagnostics) {}

    /// Checks the loads in all conditions; loads with formulas are evaluated for every trial.
    void check() {
        for (const task::TaskPlan::Cell& cell : plan_.task->cells) check(cell, false);
        if (plan_.task->formulas.empty()) return;
        task::each_trial(*plan_.task, [&](size_t, const task::TrialNumbers& numbers) {
            check(numbers.cell(), true);
        });
    }

  private:
    using Demand = task::Load::Demand;

    void check(const task::TaskPlan::Cell& cell, bool computed) {
        for (const task::Perturbation& perturbation : cell.perturbations) {
            for (const task::Load& load : perturbation.loads()) {
                if (load.is_computed() == computed) check(load);
            }
        }
    }

    void check(const task::Load& load) {
        if (load.is_computed() && load.stiffness() < 0 && !load.spec().zone)
            say({Severity::error, load.spec().place, "stiffness",
                 "is negative in a trial: the load would grow without limit as it drives the hand "
                 "away",
                 "Add e.g. safe_within_mm: 50, beyond which it fades to zero."});
        const Demand demand = load.demand();
        const auto bodies = static_cast<int>(plan_.scene.bodies.size());
        for (const int thing : load.on()) {
            if (thing < bodies) {
                check_body(load, demand, plan_.scene.bodies[static_cast<size_t>(thing)]);
                continue;
            }
            const auto finger = static_cast<size_t>(thing - bodies);
            const frame::DeviceInfo& info = plan_.devices[finger];
            check_loop(load, demand, info);
            check_force(load, demand, info);
            check_torque(load, demand, info, plan_.scene.fingers[finger].name);
        }
    }

    void warn(const task::Load& load, const std::string& key, const std::string& what,
              const std::string& remedy) {
        say({Severity::warning, load.spec().place, key, what, remedy});
    }

    /// Reports a fault, unless one that differs only in its numbers was reported before.
    void say(const Problem& problem) {
        std::string text = problem.text();
        std::erase_if(text,
                      [](char c) { return std::isdigit(static_cast<unsigned char>(c)) != 0; });
        const std::string at = fmt::format("{}:{}", problem.place.line, text);
        if (said_.insert(at).second) diagnostics_.add({problem});
    }

    static std::string a(const task::Load& load) {
        return fmt::format("a {} load", enum_name(load.spec().kind));
    }

    /// Checks a load against the limits on a coupling's stiffness and damping.
    void check_loop(const task::Load& load, const Demand& demand, const frame::DeviceInfo& info) {
        const double period = plan_.settings.tick() + 2 * (info.delay + load.delay());
        const double stiffest = model::passive_stiffness(info.damping, period);
        if (info.damping > 0 && demand.stiffness > stiffest) {
            warn(load, "stiffness",
                 fmt::format("{} of {:.4g} N/m is above {:.0f} N/m (2 b / T), the highest "
                             "stiffness at which the hand's damping of {:g} N*s/m is certain to "
                             "keep {} calm",
                             a(load), demand.stiffness, stiffest, info.damping, info.model),
                 "Lower it, or check whether the handle shakes; if a load fades, raise fade_mm.");
        }
        const double most_damped = 2 * info.mass / period;
        if (info.mass > 0 && demand.damping > most_damped) {
            warn(load, "damping",
                 fmt::format("{} of {:.4g} N*s/m is more than a handle of {:g} g can withstand: "
                             "about {:.0f} N*s/m (2 m / T)",
                             a(load), demand.damping, info.mass * 1e3, most_damped),
                 "Lower it.");
        }
        if (info.damping > 0 && demand.driving > info.damping) {
            warn(load, "damping",
                 fmt::format("{} pushes the hand on with {:.4g} N*s/m, more than the {:g} N*s/m "
                             "that the hand's own damping absorbs: the hand runs away",
                             a(load), demand.driving, info.damping),
                 "Make it weaker.");
        }
    }

    /// Checks a load against the largest force that can reach the hand.
    void check_force(const task::Load& load, const Demand& demand, const frame::DeviceInfo& info) {
        const double most = plan_.settings.safety.largest_force(info.peak_force, info.scale);
        if (std::isfinite(demand.force) && demand.force > most && !demand.holds) {
            warn(load, "force",
                 fmt::format("{} reaches {:.3g} N, more than the {:.3g} N that {} may give: it is "
                             "limited to that",
                             a(load), demand.force, most, info.model),
                 "Make it weaker, or use a rig with a stronger device.");
        }
        if (std::isinf(demand.force) && info.workspace && !demand.holds) {
            const double reach = info.workspace->norm() / 2;
            if (demand.stiffness * reach > most)
                warn(load, "force",
                     fmt::format(
                         "{} of {:.4g} N/m reaches the {:.3g} N that {} may give at {:.0f} mm, and "
                         "is limited beyond that: the workspace extends to {:.0f} mm",
                         a(load), demand.stiffness, most, info.model, most / demand.stiffness * 1e3,
                         reach * 1e3),
                     "Lower its stiffness, or limit its zone with safe_within_mm.");
        }
        if (demand.springs || demand.damping * kFastReach <= most) return;
        warn(load, "damping",
             fmt::format("{} of {:.4g} N*s/m reaches the {:.3g} N that {} may give at {:.2g} m/s, "
                         "and is limited above that: fast reaches move at {:g} m/s",
                         a(load), demand.damping, most, info.model, most / demand.damping,
                         kFastReach),
             "Lower it, or use a rig with a stronger device.");
    }

    void check_torque(const task::Load& load, const Demand& demand, const frame::DeviceInfo& info,
                      const std::string& finger) {
        if (demand.torque == 0) return;
        if (info.peak_torque <= 0) {
            say({Severity::error, load.spec().place, "torque",
                 fmt::format("{} of {} renders no torque", info.model, finger),
                 "Leave it out, let it act on a body, or use a rig with torque."});
            return;
        }
        const double most = plan_.settings.safety.largest_torque(info.peak_torque);
        if (demand.torque > most) {
            warn(load, "torque",
                 fmt::format("{} reaches {:.3g} N*m, more than the {:.3g} N*m that {} may give",
                             a(load), demand.torque, most, info.model),
                 "Make it weaker.");
        }
    }

    /// Checks a load on a body. Such loads are integrated explicitly: with stiffness k and damping
    /// b, a load is stable as long as k h^2 + 2 b h < 4 m.
    void check_body(const task::Load& load, const Demand& demand, const scene::Body& body) {
        const double h = plan_.settings.step();
        const double mass = scene::mass(body);
        if (demand.stiffness * h * h + 2 * demand.damping * h < 4 * mass) return;
        warn(load, demand.stiffness > 0 ? "stiffness" : "damping",
             fmt::format(
                 "{} of {:.4g} N/m and {:.4g} N*s/m throws a body of {:.4g} g about in steps "
                 "of {:g} ms (k h^2 + 2 b h is not below 4 m)",
                 a(load), demand.stiffness, demand.damping, mass * 1e3, h * 1e3),
             "Lower it, or make the body heavier.");
    }

    const Plan& plan_;
    Diagnostics& diagnostics_;
    std::set<std::string> said_;
};

}  // namespace

void check_loads(const Plan& plan, Diagnostics& diagnostics) {
    if (plan.task) LoadChecks(plan, diagnostics).check();
}

}  // namespace dihaptic::session
