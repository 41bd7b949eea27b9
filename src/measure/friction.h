// The command `dihaptic bench friction`: measures how solvers hold and slide bodies by friction.
// docs/measures.md defines the figures.
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
    std::optional<double> cards_drift_mm;    ///< unset if the house fell
    std::optional<double> cards_settled_mm;  ///< unset if the house fell
    int cards_storeys = 0;                  ///< of the highest house that stands; 0: fewer than two
    std::optional<double> arch_drift_mm;    ///< unset if the arch fell
    std::optional<double> arch_settled_mm;  ///< unset if the arch fell
    std::optional<double> pinch_mm;         ///< unset if the block fell
    std::optional<double> creep_mm;         ///< unset for a peer, which has no fingers
};

/// All figures of one solver.
FrictionFigures bench_friction(const dynamics::Settings& settings, const Progress& progress);
/// All figures except the creep, which fingers alone have.
FrictionFigures bench_peer_friction(const Simulator& simulator, const Progress& progress);

// Scenes of the bench, which tests use too.

/// A block on a slope, which is a box or a plane.
scene::Scene incline_scene(double slope, double turn, double friction,
                           scene::ShapeKind kind = scene::ShapeKind::box);
scene::Scene stack_scene(int blocks);
scene::Scene cards_scene(int storeys);
scene::Scene arch_scene(int voussoirs);
/// A block in the air between two pads, which the grip force pushes along x, their only freedom.
Trial pinch_trial();

std::string to_json(const std::vector<FrictionFigures>& figures);
std::string to_table(const std::vector<FrictionFigures>& figures);

}  // namespace dihaptic::measure
