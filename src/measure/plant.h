// The plant that every figure is measured on: two simulated fingers of 75 g, pulled by 300 N/m and
// 3 N*s/m, and a block of 4 cm and 100 g on a table. One definition for all benches and their
// tests.
#pragma once

#include <functional>
#include <memory>

#include "analysis/grasp_trace.h"
#include "devices/simulated/options.h"
#include "hand/script.h"
#include "rig/rig.h"
#include "servo/run.h"

namespace dihaptic::measure {

/// How the fingers hold the block.
enum class Fingering {
    ideal,  ///< centred
    real,   ///< 2 mm off, opposite ways, along the face in both directions; tremor of 0.1 mm at 8-9
            ///< Hz
    off_centre,  ///< both 5 mm above the block's centre
    offset,      ///< as real, without tremor
};
constexpr auto enum_names(Fingering) {
    return std::array{"ideal", "real", "off-centre", "offset"};
}

/// What a device does to the ideal plant.
enum class Row { ideal, delay, premium };

/// A bench's knobs: those that `dihaptic bench` offers, and those that its rows vary.
struct BenchSetup {
    servo::Settings settings;
    double mass = 0.1;  ///< of the block [kg]
    double friction = 0.8;
    Fingering fingering = Fingering::ideal;
    Row row = Row::ideal;
    std::vector<rig::Device> devices;  ///< of thumb and index, simulated; empty: ideal ones
    /// Puts another backend before them; null: they are reached directly.
    std::function<std::unique_ptr<devices::DeviceGroup>(
        const std::vector<devices::DeviceConfig>& simulated, const devices::Context& context)>
        make_devices;
    hand::Impedance impedance;
    double squeeze = 0.015;  ///< targets go so far beyond contact [m]
    double lift = 0.1;       ///< the hand rises so far [m]
    double rise_time = 1;    ///< [s]
    double hold_time = 5;    ///< [s]
    double soft_radius = 0;  ///< torsion radius, of spheres in place of pads; 0: pads [m]
    int extra_blocks = 0;    ///< on the table, behind the work
};

constexpr double kBlockSize = 0.04;      // [m]
constexpr double kSoftRadius = 0.006;    // of a soft fingertip [m]
constexpr double kPadThickness = 0.005;  // [m]
/// From a finger's proxy to its face: half a pad, or nothing for a point [m].
double reach(const BenchSetup& setup);
constexpr double kStartGap = 0.03;  // fingers start so far off the faces [m]
/// Force of a finger that presses, in closed form [N].
double press_force(const BenchSetup& setup);

scene::Scene grasp_scene(const BenchSetup& setup);
/// Close 1 s, wait 1 s, rise 1 s, hold 5 s, open 1 s.
hand::HandSpec grasp_hand(const BenchSetup& setup);
enum GraspPhase { kClose, kWait, kRise, kHold, kOpen };

/// One finger and a fixed wall at x = 0, its face looking toward -x.
scene::Scene wall_scene(const BenchSetup& setup);
hand::HandSpec wall_hand(const BenchSetup& setup);

/// What a simulated device is like. Throws Error.
devices::simulated::Options simulated_options(const rig::Device& device);

/// A servo on simulated devices in the scripted hand.
class Bench {
  public:
    Bench(const scene::Scene& scene, const hand::HandSpec& hand, const BenchSetup& setup);

    servo::Servo& servo() { return *servo_; }
    const hand::Driver& driver() const { return *driver_; }
    /// Runs the whole script; `extra` may add loads to each tick, `sink` sees each frame.
    void run(const servo::FrameSink& sink, const servo::Director& extra = {},
             servo::TickTimes* times = nullptr);

  private:
    std::unique_ptr<hand::ScriptDriver> driver_;
    std::unique_ptr<servo::Servo> servo_;
};

}  // namespace dihaptic::measure
