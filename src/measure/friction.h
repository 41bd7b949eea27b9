// `dihaptic bench friction`: definitions in docs/measures.md.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "measure/grasp.h"
#include "measure/simulator.h"

namespace dihaptic::measure {

struct FrictionFigures {
    std::string solver;
    double drift_mm = 0;
    double accel_error = 0;
    double direction_error_deg = 0;
    double stack_drift_mm = 0;               ///< from the pose drawn
    double stack_settled_mm = 0;             ///< from the pose after a second
    std::optional<double> cards_drift_mm;    ///< nothing: it fell
    std::optional<double> cards_settled_mm;  ///< the same
    int cards_storeys = 0;                  ///< of the highest house that stands; 0: fewer than two
    std::optional<double> arch_drift_mm;    ///< nothing: it fell
    std::optional<double> arch_settled_mm;  ///< the same
    std::optional<double> pinch_mm;         ///< nothing: it fell
    std::optional<double> creep_mm;         ///< nothing: a peer, which has no fingers
};

/// All figures of one solver.
FrictionFigures bench_friction(const dynamics::Settings& settings, const Progress& progress);
/// All but the creep, which is that of fingers.
FrictionFigures bench_peer_friction(const Simulator& simulator, const Progress& progress);

/// Scenes of the bench, for tests too.
/// A block on a box or on a plane.
scene::Scene incline_scene(double slope, double turn, double friction,
                           scene::ShapeKind kind = scene::ShapeKind::box);
scene::Scene stack_scene(int blocks);
scene::Scene cards_scene(int storeys);
scene::Scene arch_scene(int voussoirs);
/// A block in the air between two pads that the grip force pushes along x, all that they can move.
Trial pinch_trial();

std::string to_json(const std::vector<FrictionFigures>& figures);
std::string to_table(const std::vector<FrictionFigures>& figures);

}  // namespace dihaptic::measure
