// The command `dihaptic-bench friction`: measures holding and sliding of bodies by friction in
// solvers. docs/measures.md defines the figures.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "bench/simulator.h"
#include "measure/grasp.h"

namespace dihaptic::bench {

struct FrictionFigures {
    std::string solver;
    double drift_mm = 0;
    double accel_error = 0;
    double direction_error_deg = 0;
    double stack_drift_mm = 0;               ///< from the drawn pose
    double stack_settled_mm = 0;             ///< from the pose after a second
    std::optional<double> cards_drift_mm;    ///< unset if the house fell
    std::optional<double> cards_settled_mm;  ///< unset if the house fell
    int cards_storeys = 0;  ///< storeys of the highest stable house; 0: fewer than two
    std::optional<double> arch_drift_mm;    ///< unset if the arch fell
    std::optional<double> arch_settled_mm;  ///< unset if the arch fell
    std::optional<double> pinch_mm;         ///< unset if the block fell
    std::optional<double> creep_mm;         ///< unset for a peer, which has no fingers

    template <class Self, class Visitor>
    static void visit(Self& f, Visitor& v) {
        v("solver", f.solver, "", "our solver, or a peer");
        v("drift_mm", f.drift_mm, "mm", "on a slope below the friction angle");
        v("accel_error", f.accel_error, "1", "relative, on a slope above the friction angle");
        v("direction_error_deg", f.direction_error_deg, "deg", "from the fall line");
        v("stack_drift_mm", f.stack_drift_mm, "mm", "of ten blocks, from the drawn pose");
        v("stack_settled_mm", f.stack_settled_mm, "mm", "from the pose after a second");
        v("cards_drift_mm", f.cards_drift_mm, "mm", "of two storeys, from the drawn pose");
        v("cards_settled_mm", f.cards_settled_mm, "mm", "from the pose after a second");
        v("cards_storeys", f.cards_storeys, "1", "storeys of the highest stable house");
        v("arch_drift_mm", f.arch_drift_mm, "mm", "of nine stones, from the drawn pose");
        v("arch_settled_mm", f.arch_settled_mm, "mm", "from the pose after a second");
        v("pinch_mm", f.pinch_mm, "mm", "slip of a block between two pads in 60 s");
        v("creep_mm", f.creep_mm, "mm", "slip of a block held by fingers for 60 s");
    }
};

/// All figures of one solver.
FrictionFigures bench_friction(const frame::DynamicsSettings& settings,
                               const measure::Progress& progress);
/// All figures except the creep, which exists only with fingers.
FrictionFigures bench_peer_friction(const Simulator& simulator, const measure::Progress& progress);
/// Only slopes, stack, arch and the house of two storeys: the figures with acceptance limits.
FrictionFigures bench_slides_and_piles(const Simulator& simulator,
                                       const measure::Progress& progress);
/// Largest slip of a finger in a minute's hold [mm].
double measure_creep(const frame::DynamicsSettings& settings);

// Scenes of the bench, which tests also use.

/// A block on a slope made of a box or a plane.
scene::Scene incline_scene(double slope, double turn, double friction,
                           scene::ShapeKind kind = scene::ShapeKind::box);
scene::Scene stack_scene(int blocks);
scene::Scene cards_scene(int storeys);
scene::Scene arch_scene(int voussoirs);
/// A block in the air between two pads, pushed by the grip force along x, their only freedom.
Trial pinch_trial();

}  // namespace dihaptic::bench
