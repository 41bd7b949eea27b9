// The formulas of a task (base/formula.h), compiled once for its plan.
#pragma once

#include <span>

#include "base/formula.h"
#include "task/expression/expression.h"
#include "task/expression/quantities.h"
#include "task/plan/each.h"

namespace dihaptic::task {

struct CompiledFormula {
    Formula formula;  ///< text of the formula, with its key, unit, bounds and place in the file
    Expression expression;
    /// Factor by which to multiply the value if the text has no dimension: the key's unit.
    double scale = 1;
    double largest = 0;  ///< largest value over the planned trials

    double value(std::span<const double> values) const noexcept {
        return scale * expression(values);
    }
};

/// Calls f(Formula&) for each formula in a struct.
template <class Struct, class F>
void each_formula(Struct& value, F f) {
    each(value, Overloaded{[&](Formula& formula, std::string_view, const Place&) { f(formula); },
                           [&](FormulaVec3& vector, std::string_view, const Place&) {
                               for (Formula& component : vector) f(component);
                           }});
}

}  // namespace dihaptic::task
