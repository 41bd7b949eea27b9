// Knobs are settings that may change during a session. A director orders them, each Frame records
// their values, a replay orders them again, events.csv lists each change, and the operator's window
// has a panel for them. All of this is derived from visit().
#pragma once

#include <cmath>
#include <optional>
#include <string>

#include "base/unmeasured.h"
#include "frame/settings.h"

namespace dihaptic::frame {

/// The properties of a knob besides its value.
struct Knob {
    const char* name;  ///< name of its column in the log
    const char* unit;
    const char* what;  ///< description in one sentence
    /// Name of the knob in events.csv, in the window's log and in the panel, with & before the
    /// shortcut letter; null if the knob appears in none of these.
    const char* key = nullptr;
    const char* label = nullptr;
    double least = 0, most = 0, step = 0;  ///< range and step of a number in the panel
    const char* unset = nullptr;           ///< what NaN means for this knob
    bool eased = false;  ///< whether user changes are gradual, so that held objects are not dropped

    constexpr Knob within(double low, double high, double by) const {
        Knob k = *this;
        k.least = low;
        k.most = high;
        k.step = by;
        return k;
    }
    constexpr Knob nan_is(const char* text) const {
        Knob k = *this;
        k.unset = text;
        return k;
    }
    constexpr Knob with_ease() const {
        Knob k = *this;
        k.eased = true;
        return k;
    }
};

struct Knobs {
    CouplingKind coupling{};
    double stiffness = 0;  ///< k [N/m]
    double damping = 0;    ///< c [N*s/m]; if NaN, k h / 2 is used
    double smoothing = 0;  ///< alpha
    /// The proxy kind of all fingers whose kind may change and is not set by the scene. Code that
    /// orders a different kind must ensure that these fingers touch nothing.
    scene::ProxyKind proxy{};
    double friction_scale = 1;  ///< factor on every friction coefficient
    /// Angle of WorkspaceTurn in this tick [rad]. The angle is computed from the rate; ordering an
    /// angle has no effect.
    double workspace_turn = 0;
    double workspace_rate = 0;  ///< rate of change of workspace_turn until the next tick [rad/s]
    contact::Solver solver{};   ///< takes effect in the next step of the world

    /// Calls v(member, Knob) for each knob, in the order of the log.
    template <class Visitor>
    static void visit(Visitor&& v) {
        v(&Knobs::coupling,
          Knob{"coupling", "1", "Kind of coupling in effect.", "coupling.kind", "&Coupling"});
        v(&Knobs::stiffness, Knob{"stiffness", "N/m", "Stiffness k of the coupling in effect.",
                                  "coupling.stiffness_N_m", "Stiff&ness"}
                                 .within(1, 20000, 100)
                                 .with_ease());
        v(&Knobs::damping,
          Knob{"damping", "N*s/m", "Damping in effect; NaN: k h / 2, with h the dynamics step.",
               "coupling.damping_Ns_m", "&Damping"}
              .within(0, 50, 0.1)
              .nan_is("k h / 2")
              .with_ease());
        v(&Knobs::smoothing,
          Knob{"smoothing", "1",
               "Smoothing in effect: the fraction of the new force in the force sent.",
               "coupling.smoothing", "S&moothing"}
              .within(0.01, 1, 0.05));
        v(&Knobs::proxy, Knob{"proxy", "1",
                              "Kind of proxy in effect, for fingers without a kind of their own; a "
                              "change waits until "
                              "these fingers touch nothing.",
                              "proxy.kind", "Pro&xy"});
        v(&Knobs::friction_scale,
          Knob{"friction_scale", "1", "Factor on all coefficients of friction.",
               "friction, times the scene's", "Frict&ion"}
              .within(0, 5, 0.05));
        v(&Knobs::workspace_turn,
          Knob{"workspace_turn", "rad",
               "Angle of all devices' workspaces, counterclockwise seen from above."});
        v(&Knobs::workspace_rate,
          Knob{"workspace_rate", "rad/s", "Rate of workspace_turn until the next tick."});
        v(&Knobs::solver,
          Knob{"solver", "1", "Contact solver requested.", "dynamics.solver", "Contact so&lver"});
    }

    /// Returns the knobs at the start of a session that has these settings.
    static Knobs of(const Settings& settings) noexcept {
        Knobs out;
        out.set_coupling(settings.coupling);
        out.proxy = settings.proxy.kind;
        out.solver = settings.dynamics.solver;
        return out;
    }
    void set_coupling(const CouplingSettings& settings) noexcept {
        coupling = settings.kind;
        stiffness = settings.stiffness;
        damping = settings.damping.value_or(kUnmeasured);
        smoothing = settings.smoothing;
    }
    /// Returns the settings with the values of these knobs filled in.
    CouplingSettings coupled(CouplingSettings settings) const noexcept {
        settings.kind = coupling;
        settings.stiffness = stiffness;
        settings.damping = std::isnan(damping) ? std::nullopt : std::optional(damping);
        settings.smoothing = smoothing;
        return settings;
    }

    /// Whether two values of a knob are equal; NaN counts as equal to NaN.
    template <class T>
    static constexpr bool same(T a, T b) noexcept {
        return a == b || (a != a && b != b);
    }
};

/// Formats the value of a knob, in words.
std::string words(const Knob& knob, double value);
template <NamedEnum E>
std::string words(const Knob& /*knob*/, E value) {
    return std::string(enum_name(value));
}

}  // namespace dihaptic::frame
