// Implements the command `dihaptic tune`, which finds the stiffness, damping and smoothing with
// which a given device in a given hand holds a block calmly, and the highest stiffness that is
// still calm under each of the burdens listed below (docs/measures.md).
#pragma once

#include <array>
#include <atomic>
#include <optional>
#include <string>
#include <vector>

#include "measure/grasp.h"

namespace dihaptic::measure {

/// Result of a hold with offset fingers and no tremor, judged as in `bench grasp`.
enum class Verdict { calm, shaking, dropped };
constexpr auto enum_names(Verdict) {
    return std::array{"calm", "shaking", "dropped"};
}

/// Changes to the setup under which a proposal must be calm, in addition to the unchanged setup.
enum class Burden {
    none,
    delay,  ///< forces act one tick later
    light,  ///< the block weighs 10 g instead of 100 g
    loose,  ///< the hand has a third of the usual stiffness and damping
    firm,   ///< the hand has three times the usual stiffness and damping
};
constexpr auto enum_names(Burden) {
    return std::array{"as it is", "delay", "10 g", "loose hand", "firm hand"};
}
constexpr size_t kBurdens = 5;

struct TuneSetup {
    frame::Settings settings;
    std::vector<rig::Device> devices;  ///< simulated devices of thumb and index finger
    hand::Impedance hand;
    double grip = 0;  ///< grip force with which the hand holds the block [N]
    // grid for the search
    std::vector<double> stiffness;  ///< rising [N/m]
    std::vector<double> damping;    ///< rising [N*s/m]
    std::vector<double> smoothing;
    unsigned threads = 0;  ///< 0: one per processor; the results do not depend on it
};

/// Sets up the search on the usual grid for two fingers of a rig. Throws Error when there are fewer
/// than two fingers, or when their devices are not simulated.
TuneSetup tune_setup(const rig::Rig& rig, const std::vector<std::string>& fingers,
                     const frame::Settings& settings, const hand::Impedance& hand);

/// Verdicts, one for each burden. Other burdens than `none` are measured only if the point is calm
/// without a burden.
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
    /// Points, ordered by smoothing, then damping, then stiffness.
    std::vector<TunePoint> map;
    std::optional<TunePoint> proposal;
    /// A point 1.5 times as stiff as the proposal, which shows what limits the stiffness.
    std::optional<TunePoint> stiffer;
    bool interrupted = false;

    template <class Self, class Visitor>
    static void visit(Self& f, Visitor& v) {
        v("proposal", f.proposal, "", "the stiffest setting that is calm under every burden");
        v("stiffer", f.stiffer, "", "setting 1.5 times as stiff as the proposal");
        v("map", f.map, "", "all settings of the search");
    }
};

/// Returns the setup for a hold at one point on the map.
BenchSetup hold_setup(const TuneSetup& setup, const TunePoint& point, Burden burden);

TuneResult tune(const TuneSetup& setup, const std::atomic<bool>& stop, const Progress& progress);

/// Returns the highest K in a row of the map (one damping and smoothing) that is calm both without
/// and with the burden, and below which every other K is calm too; 0 if there is none.
double calm_limit(const TuneResult& result, double damping, double smoothing, Burden burden);

std::string to_json(const TuneResult& result, const TuneSetup& setup);
std::string to_table(const TuneResult& result, const TuneSetup& setup);
/// Returns the proposal as settings, in the format of Dihaptic's files.
std::string settings_block(const TuneResult& result, const TuneSetup& setup);

/// Returns a picture (SVG) of the map at the smoothing of the proposal; implemented in
/// tune_map.cpp.
std::string tune_map(const TuneResult& result, const TuneSetup& setup, const std::string& title);

}  // namespace dihaptic::measure
