// The command `dihaptic tune`: finds the stiffness, damping and smoothing that hold a block calmly
// on a given device in a given hand, and the highest stiffness that does so under each of the
// changes of setup listed below (docs/measures.md).
#pragma once

#include <array>
#include <atomic>
#include <optional>
#include <string>
#include <vector>

#include "measure/grasp.h"

namespace dihaptic::measure {

/// Result of a hold, judged as in `bench grasp`: offset fingers, no tremor.
enum class Verdict { calm, shaking, dropped };
constexpr auto enum_names(Verdict) {
    return std::array{"calm", "shaking", "dropped"};
}

/// Changes of the setup that a proposal must withstand, besides the setup itself.
enum class Burden {
    none,
    delay,  ///< forces act one tick later
    light,  ///< a block of 10 g in place of 100 g
    loose,  ///< a hand of a third of the stiffness and damping
    firm,   ///< a hand of three times the stiffness and damping
};
constexpr auto enum_names(Burden) {
    return std::array{"as it is", "delay", "10 g", "loose hand", "firm hand"};
}
constexpr size_t kBurdens = 5;

struct TuneSetup {
    frame::Settings settings;
    std::vector<rig::Device> devices;  ///< simulated devices of thumb and index
    hand::Impedance hand;
    double grip = 0;  ///< grip force with which the block is held [N]
    // grid of the search
    std::vector<double> stiffness;  ///< rising [N/m]
    std::vector<double> damping;    ///< rising [N*s/m]
    std::vector<double> smoothing;
    unsigned threads = 0;  ///< 0: one per processor; results do not depend on it
};

/// Sets up the search for two fingers of a rig, on the usual grid. Throws Error when there are
/// fewer than two, or when their devices are not simulated.
TuneSetup tune_setup(const rig::Rig& rig, const std::vector<std::string>& fingers,
                     const frame::Settings& settings, const hand::Impedance& hand);

/// Verdicts by burden; the other burdens are measured only if `none` is calm.
struct Verdicts {
    std::array<std::optional<Verdict>, kBurdens> all;

    std::optional<Verdict>& operator[](Burden burden) { return all[static_cast<size_t>(burden)]; }
    std::optional<Verdict> operator[](Burden burden) const {
        return all[static_cast<size_t>(burden)];
    }

    template <class Self, class Visitor>
    static void visit(Self& f, Visitor& v) {
        for (size_t i = 0; i < kBurdens; ++i)
            v(enum_name(static_cast<Burden>(i)), f.all[i], "", "");
    }
};

struct TunePoint {
    double k = 0;
    double c = 0;
    double smoothing = 1;
    Verdicts verdicts;

    bool calm(Burden burden) const { return verdicts[burden] == Verdict::calm; }
    bool calm_with_margin() const;

    template <class Self, class Visitor>
    static void visit(Self& f, Visitor& v) {
        v("stiffness_n_m", f.k, "N/m", "stiffness of the coupling");
        v("damping_ns_m", f.c, "N*s/m", "damping of the coupling");
        v("smoothing", f.smoothing, "1", "smoothing of dual springs");
        v("verdicts", f.verdicts, "", "verdicts by burden");
    }
};

struct TuneResult {
    /// Points by smoothing, then damping, then stiffness.
    std::vector<TunePoint> map;
    std::optional<TunePoint> proposal;
    /// A point 1.5 times as stiff as the proposal, to show what limits it.
    std::optional<TunePoint> stiffer;
    bool interrupted = false;

    template <class Self, class Visitor>
    static void visit(Self& f, Visitor& v) {
        v("proposal", f.proposal, "", "the stiffest setting that is calm under every burden");
        v("stiffer", f.stiffer, "", "setting 1.5 times as stiff as the proposal");
        v("map", f.map, "", "all settings of the search");
    }
};

/// The setup of a hold at one point on the map.
BenchSetup hold_setup(const TuneSetup& setup, const TunePoint& point, Burden burden);

TuneResult tune(const TuneSetup& setup, const std::atomic<bool>& stop, const Progress& progress);

/// Highest K of a row of the map (one damping and smoothing) that is calm, both without and with
/// the burden, as are all below it; 0 if there is none.
double calm_limit(const TuneResult& result, double damping, double smoothing, Burden burden);

std::string to_json(const TuneResult& result, const TuneSetup& setup);
std::string to_table(const TuneResult& result, const TuneSetup& setup);
/// The proposal as settings, in the format of Dihaptic's files.
std::string settings_block(const TuneResult& result, const TuneSetup& setup);

/// The map at the proposal's smoothing, as a picture (SVG), drawn in tune_map.cpp.
std::string tune_map(const TuneResult& result, const TuneSetup& setup, const std::string& title);

}  // namespace dihaptic::measure
