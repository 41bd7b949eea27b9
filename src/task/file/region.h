// A named spherical region of a task.
#pragma once

#include <string>

#include "base/field_reader.h"
#include "base/formula.h"

namespace dihaptic::task {

/// A named sphere that serves as a location for hands and that can be displayed.
struct Region {
    std::string name;
    FormulaVec3 position;   ///< centre [m]
    Formula radius = 0.01;  ///< [m]
    Place place;

    template <class Visitor>
    void visit(Visitor& v) {
        v("name", name, Field::text().required().says("Name of the region."));
        v("position", position,
          Field::length().within(-100, 100).required().says("Centre of the region."));
        v("radius", radius, Field::length().within(1e-4, 10).says("Radius of the region."));
    }
};

}  // namespace dihaptic::task
