// The command `dihaptic-bench public`: tests of holding that users of other simulators have
// published. docs/measures.md defines the figures and names their sources.
#pragma once

#include <optional>
#include <string>

#include "bench/simulator.h"
#include "measure/grasp.h"

namespace dihaptic::bench {

struct PublicFigures {
    std::string solver;
    std::optional<double> capsule_12_um_s;  ///< unset if the capsule fell
    std::optional<double> capsule_60_um_s;
    std::optional<double> holds_from;  ///< unset if no tested friction holds the block
    std::optional<double> slips_to;    ///< unset if every tested friction holds the block
    std::optional<double> pushed_um_s;
    std::optional<double> lift_slip_mm;  ///< unset if the block fell
    std::optional<double> grip_n;        ///< unset for a peer, which has no fingers

    template <class Self, class Visitor>
    static void visit(Self& f, Visitor& v) {
        v("solver", f.solver, "", "our solver, or a peer");
        v("capsule_12_um_s", f.capsule_12_um_s, "", "sinking of a capsule pinched by 12 N [um/s]");
        v("capsule_60_um_s", f.capsule_60_um_s, "", "sinking of a capsule pinched by 60 N [um/s]");
        v("holds_from", f.holds_from, "1", "least friction that holds, over the critical one");
        v("slips_to", f.slips_to, "1", "most friction that slips, over the critical one");
        v("pushed_um_s", f.pushed_um_s, "", "creep at half of the limit of friction [um/s]");
        v("lift_slip_mm", f.lift_slip_mm, "mm", "slip of a block of 500 g in a pinch and lift");
        v("grip_n", f.grip_n, "", "grip force of fingers that hold a block [N]");
    }
};

/// All figures of one of our solvers.
PublicFigures bench_public(const frame::DynamicsSettings& settings,
                           const measure::Progress& progress);
/// All figures except the grip force, which exists only with fingers.
PublicFigures bench_peer_public(const Simulator& simulator, const measure::Progress& progress);
/// Mean grip force of two fingers that hold the block of `bench grasp` [N].
double measure_grip(const frame::DynamicsSettings& settings);

}  // namespace dihaptic::bench
