// `dihaptic tune`: which stiffness, damping and smoothing hold a block calmly on a given device in
// a given hand, and the stiffest that still does when things get worse (docs/measures.md).
#pragma once

#include <array>
#include <atomic>
#include <optional>
#include <string>
#include <vector>

#include "measure/grasp.h"

namespace dihaptic::measure {

/// What became of a hold. Judged as in `bench grasp`: offset fingers, no tremor.
enum class Verdict { calm, shaking, dropped };
constexpr auto enum_names(Verdict) {
    return std::array{"calm", "shaking", "dropped"};
}

/// As it is, and what a proposal must bear besides.
enum class Burden {
    none,
    delay,  ///< forces act one tick later
    light,  ///< a block of 10 g in place of 100 g
    loose,  ///< a hand of a third of the stiffness and damping
    firm,   ///< a hand of three times both
};
constexpr auto enum_names(Burden) {
    return std::array{"as it is", "delay", "10 g", "loose hand", "firm hand"};
}
constexpr size_t kBurdens = 5;

struct TuneSetup {
    servo::Settings settings;
    std::vector<rig::Device> devices;  ///< of thumb and index, simulated
    hand::Impedance hand;
    double grip = 0;  ///< with which the block is held [N]
    // what is searched
    std::vector<double> stiffness;  ///< rising [N/m]
    std::vector<double> damping;    ///< rising [N*s/m]
    std::vector<double> smoothing;
    unsigned threads = 0;  ///< 0: as many as there are processors; results do not depend on it
};

/// The search for two fingers of a rig, on the usual grid. Throws Error when there are not two, or
/// when their devices are not simulated ones.
TuneSetup tune_setup(const rig::Rig& rig, const std::vector<std::string>& fingers,
                     const servo::Settings& settings, const hand::Impedance& hand);

struct TunePoint {
    double k = 0;
    double c = 0;
    double smoothing = 1;
    /// By Burden; beyond `none` unmeasured unless that is calm.
    std::array<std::optional<Verdict>, kBurdens> verdicts;

    bool calm(Burden burden) const {
        return verdicts[static_cast<size_t>(burden)] == Verdict::calm;
    }
    bool calm_with_margin() const;
};

struct TuneResult {
    /// By smoothing, then damping, then stiffness.
    std::vector<TunePoint> map;
    std::optional<TunePoint> proposal;
    /// 1.5 times as stiff, for what ends it.
    std::optional<TunePoint> stiffer;
    bool interrupted = false;
};

/// Holds on one point of the map.
BenchSetup hold_setup(const TuneSetup& setup, const TunePoint& point, Burden burden);

TuneResult tune(const TuneSetup& setup, const std::atomic<bool>& stop, const Progress& progress);

/// Highest K of a row of the map (one damping and smoothing) up to which every K is calm as it is
/// and under the burden; 0 when none is.
double calm_limit(const TuneResult& result, double damping, double smoothing, Burden burden);

std::string to_json(const TuneResult& result, const TuneSetup& setup);
std::string to_table(const TuneResult& result, const TuneSetup& setup);
/// The proposal as a file of Dihaptic has it.
std::string settings_block(const TuneResult& result, const TuneSetup& setup);

/// The map at the proposal's smoothing, as a picture (SVG): tune_map.cpp.
std::string tune_map(const TuneResult& result, const TuneSetup& setup, const std::string& title);

}  // namespace dihaptic::measure
