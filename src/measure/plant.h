// The plant used in all benchmarks and their tests: two simulated fingers of 75 g, each pulled by a
// hand with 300 N/m and 3 N*s/m, and a block of 4 cm and 100 g on a table.
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
    real,   ///< 2 mm off centre, in opposite directions, along both axes of the face; with a tremor
            ///< of 0.1 mm at 8-9 Hz
    off_centre,  ///< both fingers 5 mm above the block's centre
    offset,      ///< like `real`, but without tremor
};
constexpr auto enum_names(Fingering) {
    return std::array{"ideal", "real", "off-centre", "offset"};
}

/// Imperfections that a device adds to the ideal plant.
enum class Row { ideal, delay, premium };

/// Parameters of a benchmark: those that `dihaptic bench` offers as options, and those that differ
/// between the rows of its table.
struct BenchSetup {
    frame::Settings settings;
    double mass = 0.1;  ///< mass of the block [kg]
    double friction = 0.8;
    Fingering fingering = Fingering::ideal;
    Row row = Row::ideal;
    std::vector<rig::Device> devices;  ///< simulated devices of thumb and index; empty: ideal ones
    /// Wraps the devices in another backend. If null, the devices are used directly.
    std::function<std::unique_ptr<devices::DeviceGroup>(
        const std::vector<devices::DeviceConfig>& simulated, const devices::Context& context)>
        make_devices;
    hand::Impedance impedance;
    double squeeze = 0.015;  ///< distance of the hand's targets beyond the contact [m]
    double lift = 0.1;       ///< height by which the hand rises [m]
    double rise_time = 1;    ///< [s]
    double hold_time = 5;    ///< [s]
    double soft_radius = 0;  ///< torsion radius of spheres that replace pads; 0: pads [m]
    int extra_blocks = 0;    ///< number of additional blocks on the table, behind the held block
};

constexpr double kBlockSize = 0.04;      // [m]
constexpr double kSoftRadius = 0.006;    // torsion radius of a soft fingertip [m]
constexpr double kPadThickness = 0.005;  // [m]
/// Distance from a finger's proxy to its contact face: half a pad, or 0 for a point [m].
double reach(const BenchSetup& setup);
constexpr double kStartGap = 0.03;  // initial distance of the fingers from the faces [m]
/// Returns the force of a pressing finger, in closed form [N].
double press_force(const BenchSetup& setup);

scene::Scene grasp_scene(const BenchSetup& setup);
/// Returns the script of the hand. The default durations are: close 1 s, wait 1 s, rise 1 s, hold 5
/// s, open 1 s.
hand::HandSpec grasp_hand(const BenchSetup& setup);
enum GraspPhase { kClose, kWait, kRise, kHold, kOpen };

/// Returns a scene with one finger and a fixed wall at x = 0 that faces -x.
scene::Scene wall_scene(const BenchSetup& setup);
hand::HandSpec wall_hand(const BenchSetup& setup);

/// Reads the options of a simulated device from its configuration. Throws Error when they cannot be
/// read.
devices::simulated::Options simulated_options(const rig::Device& device);

/// A servo with simulated devices that are held by a scripted hand.
class Bench {
  public:
    Bench(const scene::Scene& scene, const hand::HandSpec& hand, const BenchSetup& setup);

    servo::Servo& servo() { return *servo_; }
    const hand::Driver& driver() const { return *driver_; }
    /// Runs the whole script. `extra` may add loads in each tick; `sink` receives each frame.
    void run(const frame::FrameSink& sink, const frame::Director& extra = {},
             servo::TickTimes* times = nullptr);

  private:
    std::unique_ptr<hand::ScriptDriver> driver_;
    std::unique_ptr<servo::Servo> servo_;
};

}  // namespace dihaptic::measure
