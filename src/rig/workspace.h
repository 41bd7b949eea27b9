// Where the devices of a rig get to, and where all of them do.
//
// A device's reach is what its joints allow, or the box that it is said to have. The intersection
// is found on a grid of points; README.md says how, and how exact that is.
#pragma once

#include <functional>
#include <optional>

#include "rig/rig.h"

namespace dihaptic::rig {

/// Where one device gets to.
class Reach {
  public:
    /// Throws Error when the device does not say where its reach ends.
    Reach(const Device& device, const devices::DeviceInfo& info);

    bool contains(const Vec3& p_WH) const;
    /// Smallest box along the world's axes around it [m].
    const Eigen::AlignedBox3d& bounds() const { return bounds_; }
    const std::string& finger() const { return finger_; }

  private:
    std::string finger_;
    Pose X_DW_;
    double scale_;
    std::optional<model::PhantomLinks> arm_;
    Vec3 half_ = Vec3::Zero();  // of the box's edges [m]
    Eigen::AlignedBox3d bounds_;
};

/// Of all devices of a rig. Throws Error as the rig's backend does.
std::vector<Reach> reaches(const Rig& rig);

/// What is seen from above: which columns of points hold any that count.
struct Shadow {
    std::vector<uint8_t> held;  ///< by y, then x
};

struct Workspace {
    double spacing = 0;  ///< of the grid's points [m]
    Vec3 first = Vec3::Zero();
    Eigen::Vector3i size = Eigen::Vector3i::Zero();  ///< points along x, y, z
    std::vector<double> volumes;                     ///< of each device's reach [m^3]
    double shared = 0;                               ///< volume of the intersection [m^3]
    std::vector<Shadow> shadows;                     ///< of each device's reach
    Shadow shared_shadow;
    Eigen::AlignedBox3d box;  ///< largest along the world's axes within the intersection [m]
    Vec3 sphere_centre = Vec3::Zero();
    double sphere_radius = 0;  ///< [m]

    bool holds(const Shadow& shadow, int x, int y) const {
        return shadow.held[static_cast<size_t>(y) * static_cast<size_t>(size.x()) +
                           static_cast<size_t>(x)] != 0;
    }
};

/// `progress` gets the share that is done, and returns false to give up: then the result is empty.
Workspace find_workspace(const std::vector<Reach>& reaches,
                         const std::function<bool(double share)>& progress);

/// Where a world fits into a workspace that is not empty, and a wall around it.
struct Placement {
    Vec3 origin;  ///< of the world: over the middle of the box's floor, by kUnderTable [m]
    Wall wall;    ///< the largest box
};
Placement propose_placement(const Workspace& workspace);
/// Hands may press a table's top, and reach an object's lower edge.
constexpr double kUnderTable = 0.01;  // [m]

/// Share of a box that not every device reaches.
double out_of_reach(const Eigen::AlignedBox3d& box, const std::vector<Reach>& reaches);

/// SVG text: the reaches and what they share, from above.
std::string workspace_picture(const Workspace& workspace, const std::vector<Reach>& reaches,
                              const std::string& title);

}  // namespace dihaptic::rig
