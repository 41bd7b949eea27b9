// These functions add the parts of the module dihaptic._native to it. What the module returns is
// plain: the package's own sources make its public classes of that.
#pragma once

#include <pybind11/pybind11.h>

namespace dihaptic::python {

/// Makes an Error of the program's an Error of the package's, with its problems.
void add_errors(pybind11::module_& m);
/// What the program knows of quantities, columns, colours and files.
void add_vocabulary(pybind11::module_& m);
void add_fits(pybind11::module_& m);
void add_lifts(pybind11::module_& m);
void add_world(pybind11::module_& m);
void add_person(pybind11::module_& m);

}  // namespace dihaptic::python
