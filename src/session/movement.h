// Fits a recorded movement to a scene: moves the grasp to the block's position, and turns and
// resizes the block so that the fingers reach its faces as they reached the recorded object.
#pragma once

#include <memory>
#include <optional>

#include "hand/recorded.h"
#include "scene/scene.h"
#include "task/file/experiment.h"

namespace dihaptic::session {

/// What place_movement() found in a recorded movement.
struct MovementReport {
    std::string file;
    std::string checksum;  ///< checksum of the text that was read (base/checksum.h)
    std::vector<hand::Fault> faults;
    std::vector<std::string> fingers;
    double duration = 0;  ///< [s]
    double bridged_share = 0;
    hand::GraspSite site;
    double block_width = 0;  ///< width of the block along the grasp axis [m]
};

constexpr const char* kNoGrasp =
    "no grasp was found: the fingers never open, close and come to rest away from their start";

/// Warns if so much of the path is interpolated across gaps that it says little about the hand.
void warn_of_bridges(const hand::Path& path, const std::string& file, Diagnostics& diagnostics);

/// Reads and repairs the movement, finds its grasp, turns and resizes the scene's block, and turns
/// the proxies of the fingers to face the block. Returns the driver, or null if there were errors,
/// which are in `diagnostics`. `asked_at` is the line of the experiment that requests the movement,
/// for use in messages.
std::shared_ptr<const hand::Driver> place_movement(const task::MovementSpec& spec,
                                                   const std::string& file, const Place& asked_at,
                                                   scene::Scene& scene,
                                                   std::optional<MovementReport>& report,
                                                   Diagnostics& diagnostics);

}  // namespace dihaptic::session
