// Describes a soft body, such as a sponge or a flexible rod, as given in a scene file: rows and
// layers of rigid blocks, joined by springs that yield like the material.
//
// For a material with Young's modulus E and shear modulus G, two blocks whose centres are a
// distance L apart and that share a face of area A are joined by a bushing in the middle of this
// face, with
//
//     k = E A / L across it     G A / L along it     E I / L about its sides     G J / L about its
//     normal
//
// where I denotes the face's second moments of area and J is Saint-Venant's torsion constant. Bars
// and beams made in this way stretch, shear and twist as described in textbooks, and the bending of
// n blocks agrees with that of a beam to within 1 / (2 n^2). The sides of a block do not bulge when
// it is pressed, i.e. Poisson's ratio is 0. The faces of a block are soft, with a stiffness of 2 E
// A / L (averaged over its three directions), because an object that presses on a face is half a
// block away from the first link.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "base/diagnostics.h"
#include "base/field_reader.h"
#include "scene/shape.h"
#include "scene/surface.h"

namespace dihaptic::scene {

struct Scene;

/// A face of a lattice, named after its outward normal: -x, +x and so on in the axes of the
/// lattice.
enum class Side { x_low, x_high, y_low, y_high, z_low, z_high };
constexpr auto enum_names(Side) {
    return std::array{"-x", "+x", "-y", "+y", "-z", "+z"};
}

/// A face of a lattice that is glued to a body or to the world, by links of half the usual length.
struct Glued {
    Side side = Side::x_low;
    std::string to;  ///< name of the body; empty stands for the world
    Place place;

    template <class Visitor>
    void visit(Visitor& v) {
        v("side", side, says("The glued face, by its outward normal."));
        v("to", to, says("Body to which the face is glued; if left out, the world."));
    }
};

struct Lattice {
    std::string name;
    Vec3 size = Vec3::Zero();       ///< size of the entire lattice [m]
    Vec3 parts{2, 2, 2};            ///< number of blocks along the lattice's x, y and z axes
    Vec3 position = Vec3::Zero();   ///< initial position of the lattice's centre [m]
    Vec3 rotation = Vec3::Zero();   ///< rotation about the fixed axes x, then y, then z [rad]
    std::optional<double> mass;     ///< mass of the entire lattice [kg]; replaces the density
    std::optional<double> density;  ///< [kg/m^3]
    double young = 1e5;             ///< E [Pa]
    std::optional<double> shear;    ///< shear modulus G [Pa]; E / 2 if unset
    double retardation = 0;         ///< ratio of damping to stiffness (Kelvin-Voigt model) [s]
    double friction = 0.8;
    std::string colour;
    std::vector<Glued> glued;
    Place place;

    template <class Visitor>
    void visit(Visitor& v) {
        const Field modulus = Field::of(Quantity::pressure).within(1, 1e12);
        v("name", name,
          Field::text().required().says(
              "Name; the blocks are called name_1, name_2 and so on in a rod, otherwise "
              "name_1_1_1, by x, y and z."));
        v("size", size,
          Field::length().within(1e-4, 100).required().says("Size of the entire lattice."));
        v("parts", parts,
          Field::number().within(1, 100).says("Number of blocks along the lattice's x, y and z."));
        v("position", position,
          Field::length().within(-100, 100).says("Position of the centre at the start."));
        v("rotation", rotation,
          Field::of(Quantity::angle)
              .within(-kMostTurn, kMostTurn)
              .says("Rotation at the start, about the world's axes x, then y, then z."));
        v("mass", mass,
          Field::of(Quantity::mass).within(1e-6, 1000).says("Mass of the entire lattice."));
        v("density", density,
          Field::of(Quantity::density).within(0.01, 1e5).says("Density, in place of the mass."));
        v("young", young, modulus.says("Young's modulus of the material."));
        v("shear", shear, modulus.says("Shear modulus; if left out, half of Young's modulus."));
        v("retardation", retardation,
          Field::of(Quantity::time)
              .within(0, 10)
              .says("Retardation time: each spring has a damper of this time multiplied by its "
                    "stiffness."));
        v("friction", friction,
          Field::number().within(0, kMostFriction).says("Coefficient of friction, as for a body."));
        v("colour", colour, says("Colour, as \"#rrggbb\"; if left out, the view chooses."));
        v("glued", glued, says("Faces glued to bodies or to the world."));
    }
};

/// Turns the lattices of a scene into bodies and joints, which are appended to the existing ones.
void expand_lattices(Scene& scene, Diagnostics& diagnostics);

}  // namespace dihaptic::scene
