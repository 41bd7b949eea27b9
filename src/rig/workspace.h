// The workspace of a rig: the reach of each of its devices, and their intersection.
//
// A device's reach follows from its joint limits, or is the box that the device or its options
// state. The intersection is found on a grid of points; README.md describes the method and its
// accuracy.
#pragma once

#include <functional>
#include <optional>

#include "rig/rig.h"

namespace dihaptic::rig {

/// The reach of one device.
class Reach {
  public:
    /// Throws Error if the device does not state its reach.
    Reach(const Device& device, const frame::DeviceInfo& info);

    bool contains(const Vec3& p_WH) const;
    /// A box along the world's axes that contains the reach [m].
    const Eigen::AlignedBox3d& bounds() const { return bounds_; }
    const std::string& finger() const { return finger_; }

  private:
    std::string finger_;
    Pose X_DW_;
    double scale_;
    std::optional<model::PhantomLinks> arm_;
    Vec3 half_ = Vec3::Zero();  // half the box's edges [m]
    Eigen::AlignedBox3d bounds_;
};

/// The reaches of all devices of a rig. Throws Error like the rig's backend.
std::vector<Reach> reaches(const Rig& rig);

/// A reach seen from above: the columns of grid points with any point in it.
struct Shadow {
    std::vector<uint8_t> held;  ///< by y, then x
};

struct Workspace {
    double spacing = 0;                              ///< spacing of the grid's points [m]
    Vec3 first = Vec3::Zero();                       ///< first point of the grid, in the world [m]
    Eigen::Vector3i size = Eigen::Vector3i::Zero();  ///< number of points along x, y, z
    std::vector<double> volumes;                     ///< volume of each device's reach [m^3]
    double shared = 0;                               ///< volume of the intersection [m^3]
    std::vector<Shadow> shadows;                     ///< shadow of each device's reach
    Shadow shared_shadow;
    /// Largest box along the world's axes within the intersection [m].
    Eigen::AlignedBox3d box;
    /// Largest sphere within the intersection [m].
    Vec3 sphere_centre = Vec3::Zero();
    double sphere_radius = 0;  ///< [m]

    bool holds(const Shadow& shadow, int x, int y) const {
        return shadow.held[static_cast<size_t>(y) * static_cast<size_t>(size.x()) +
                           static_cast<size_t>(x)] != 0;
    }
};

/// `progress` gets the fraction done, and returns false to cancel; the result is then empty.
Workspace find_workspace(const std::vector<Reach>& reaches,
                         const std::function<bool(double share)>& progress);

/// A proposal for the world's origin and the wall in a non-empty workspace.
struct Placement {
    Vec3 origin;  ///< origin of the world: kUnderTable above the middle of the box's floor [m]
    Wall wall;    ///< the largest box
};
Placement propose_placement(const Workspace& workspace);
/// Reach below a table's top, for hands that press it or grasp an object's lower edge.
constexpr double kUnderTable = 0.01;  // [m]

/// Fraction of a box not reached by every device.
double out_of_reach(const Eigen::AlignedBox3d& box, const std::vector<Reach>& reaches);

/// SVG text: the reaches and their intersection, seen from above.
std::string workspace_picture(const Workspace& workspace, const std::vector<Reach>& reaches,
                              const std::string& title);

}  // namespace dihaptic::rig
