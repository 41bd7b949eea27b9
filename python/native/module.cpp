#include <string>

#include "base/diagnostics.h"
#include "parts.h"

namespace py = pybind11;

namespace dihaptic::python {
namespace {

void raise(const Error& error) {
    const py::module_ errors = py::module_::import("dihaptic.errors");
    py::list problems;
    for (const Problem& p : error.problems()) {
        const char* severity = p.severity == Severity::error ? "error" : "warning";
        problems.append(
            errors.attr("Problem")(severity, p.place.file, p.place.line, p.key, p.what, p.remedy));
    }
    const py::object type = errors.attr("Error");
    PyErr_SetObject(type.ptr(), type(problems).ptr());
}

}  // namespace

void add_errors(py::module_&) {
    py::register_exception_translator([](std::exception_ptr thrown) {
        try {
            if (thrown) std::rethrow_exception(thrown);
        } catch (const Error& error) {
            raise(error);
        }
    });
}

}  // namespace dihaptic::python

PYBIND11_MODULE(_native, m) {
    using namespace dihaptic::python;
    add_errors(m);
    add_vocabulary(m);
    add_fits(m);
    add_lifts(m);
    add_world(m);
    add_person(m);
}
