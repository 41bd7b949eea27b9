// The workspace of a rig: the reach of each device, and the intersection of all reaches.
//
// The reach of a device is computed from its joint limits, or is the box that the device or its
// options state. The intersection is found on a grid of points; README.md describes the method and
// its accuracy.
#pragma once

#include <functional>
#include <optional>

#include "rig/rig.h"

namespace dihaptic::rig {

/// The reach of one device.
class Reach {
  public:
    /// Computes the reach of a device. Throws Error if the device does not state its reach.
    Reach(const Device& device, const frame::DeviceInfo& info);

    bool contains(const Vec3& p_WH) const;
    /// An axis-aligned box that contains the reach, in the world [m].
    const Eigen::AlignedBox3d& bounds() const { return bounds_; }
    const std::string& finger() const { return finger_; }

  private:
    std::string finger_;
    Pose X_DW_;
    double scale_;
    std::optional<model::PhantomLinks> arm_;
    Vec3 half_ = Vec3::Zero();  // half the edge lengths of the box [m]
    Eigen::AlignedBox3d bounds_;
};

/// The reaches of all the devices of a rig. Throws Error in the same cases as the rig's backend.
std::vector<Reach> reaches(const Rig& rig);

/// A reach seen from above, i.e. the columns of the grid in which at least one point is within
/// reach.
struct Shadow {
    std::vector<uint8_t> held;  ///< one value per column, ordered by y, then x
};

struct Workspace {
    double spacing = 0;                              ///< spacing of the grid points [m]
    Vec3 first = Vec3::Zero();                       ///< first grid point, in the world [m]
    Eigen::Vector3i size = Eigen::Vector3i::Zero();  ///< number of grid points along x, y and z
    std::vector<double> volumes;                     ///< volume of the reach of each device [m^3]
    double shared = 0;                               ///< volume of the intersection [m^3]
    std::vector<Shadow> shadows;                     ///< shadow of the reach of each device
    Shadow shared_shadow;
    /// The largest axis-aligned box within the intersection, in the world [m].
    Eigen::AlignedBox3d box;
    /// The largest sphere within the intersection [m].
    Vec3 sphere_centre = Vec3::Zero();
    double sphere_radius = 0;  ///< [m]

    bool holds(const Shadow& shadow, int x, int y) const {
        return shadow.held[static_cast<size_t>(y) * static_cast<size_t>(size.x()) +
                           static_cast<size_t>(x)] != 0;
    }
};

/// Finds the workspace. `progress` is called with the fraction done, and may throw to give up.
Workspace find_workspace(
    const std::vector<Reach>& reaches,
    const std::function<void(double share)>& progress = [](double) {});

/// A proposal for the origin of the world and for the wall, in a workspace that is not empty.
struct Placement {
    Vec3 origin;  ///< origin of the world: kUnderTable above the middle of the box's floor [m]
    Wall wall;    ///< the largest box
};
Placement propose_placement(const Workspace& workspace);
/// Reach below the top of a table, which hands need to press the table or to grasp an object at its
/// lower edge.
constexpr double kUnderTable = 0.01;  // [m]

/// The fraction of a box that is out of reach of at least one device.
double out_of_reach(const Eigen::AlignedBox3d& box, const std::vector<Reach>& reaches);

/// SVG text of a picture of the reaches and their intersection, seen from above.
std::string workspace_picture(const Workspace& workspace, const std::vector<Reach>& reaches,
                              const std::string& title);

}  // namespace dihaptic::rig
