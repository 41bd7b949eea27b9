#include "analysis/lifts.h"

#include <pybind11/stl.h>

#include <algorithm>
#include <cmath>

#include "base/diagnostics.h"
#include "base/figure.h"
#include "frame_values.h"
#include "parts.h"

namespace py = pybind11;

namespace dihaptic::python {
namespace {

/// A frame with only the forces and heights of a tick: each digit presses the object along x, and
/// carries it along z.
class Forces {
  public:
    Forces(const Array& grip, const Array& load, const Array& height, double tick)
        : grip_(grip), load_(load), height_(height), tick_(tick) {
        const auto digits = static_cast<size_t>(grip.shape(1));
        frame_.bodies.resize(1);
        frame_.fingers.resize(digits);
        frame_.contacts.resize(digits);
    }
    const frame::Frame& at(py::ssize_t i) {
        frame_.time = from_seconds(static_cast<double>(i) * tick_);
        frame::BodyFrame& object = frame_.bodies.front();
        object.v_WB.z() = i == 0 ? 0 : (height_.at(i) - height_.at(i - 1)) / tick_;
        object.X_WB.p.z() = height_.at(i);
        for (size_t digit = 0; digit < frame_.contacts.size(); ++digit) {
            const auto f = static_cast<py::ssize_t>(digit);
            frame::ContactFrame& contact = frame_.contacts[digit];
            contact.a = 0;
            contact.b = static_cast<int32_t>(1 + digit);
            contact.n_W = Vec3::UnitX();
            contact.normal_force = grip_.at(i, f);
            contact.f_B_W = {grip_.at(i, f), 0, -load_.at(i, f)};
        }
        return frame_;
    }

  private:
    const Array& grip_;
    const Array& load_;
    const Array& height_;
    double tick_;
    frame::Frame frame_;
};

void check_shapes(const Array& grip, const Array& load, const Array& height, size_t digits) {
    if (grip.ndim() != 2 || load.ndim() != 2 || grip.shape(0) != load.shape(0) ||
        grip.shape(1) != load.shape(1) || height.ndim() != 1 || height.shape(0) != grip.shape(0)) {
        throw Error("the arrays do not match",
                    "Give grip and load with one row per sample and one column per digit, and "
                    "height with one value per sample.");
    }
    if (grip.size() == 0)
        throw Error("there is no sample, or no digit",
                    "Give one row per sample and one column per digit.");
    if (digits != static_cast<size_t>(grip.shape(1)))
        throw Error({}, "friction", "has a length that differs from the number of digits",
                    "Give one for each digit.");
}

void check_numbers(const Array& values) {
    if (!std::all_of(values.data(), values.data() + values.size(),
                     [](double x) { return std::isfinite(x); }))
        throw Error("a force or a height is not a number", "Cut the trial to the measured part.");
}

py::dict find_lift(const Array& grip, const Array& load, const Array& height, double tick,
                   const std::vector<double>& friction) {
    check_shapes(grip, load, height, friction.size());
    for (const Array* values : {&grip, &load, &height}) check_numbers(*values);
    for (const double coefficient : friction) {
        if (!(coefficient > 0 && coefficient <= 100))
            throw Error({}, "friction", "is not above 0", "Give the coefficient of each digit.");
    }
    if (!(tick > 0 && tick <= 0.02))
        throw Error({}, "tick", "is not between 0 and 20 ms",
                    "Give the time between samples in s.");
    analysis::GraspTrace trace(0, tick);
    Forces forces(grip, load, height, tick);
    for (py::ssize_t i = 0; i < grip.shape(0); ++i) trace.add(forces.at(i));
    const rows::LiftRow lift =
        analysis::find_lift(trace, {0, 0, -9.81}, friction, rows::EventRule::force);
    const FigureLister figures = list_figures(lift);
    py::dict out;
    for (size_t i = 0; i < figures.columns.size(); ++i)
        std::visit([&](const auto& cell) { out[py::str(figures.columns[i].name)] = cell; },
                   figures.cells[i]);
    return out;
}

}  // namespace

void add_lifts(py::module_& m) {
    m.def("find_lift", &find_lift);
}

}  // namespace dihaptic::python
