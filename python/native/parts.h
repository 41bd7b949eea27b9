// These functions add the parts of the module dihaptic._native to it. The module returns plain
// values, from which the package's own sources make its public classes.
#pragma once

#include <pybind11/pybind11.h>

namespace dihaptic::python {

/// Converts an Error of the program to an Error of the package, with its problems.
void add_errors(pybind11::module_& m);
/// The program's facts about quantities, columns, colours and files.
void add_vocabulary(pybind11::module_& m);
void add_fits(pybind11::module_& m);
void add_lifts(pybind11::module_& m);
void add_world(pybind11::module_& m);
void add_person(pybind11::module_& m);

}  // namespace dihaptic::python
