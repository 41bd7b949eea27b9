// The formulas of a task (base/formula.h), compiled once for its plan.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

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

/// Quantities that formulas can use, and the slots that hold their values.
struct Symbols {
    struct Draw {
        int slot;
        double si;                  ///< unit of the draw's name, as a multiple of the SI unit
        std::vector<double> codes;  ///< codes of the draw's values if they are texts
        double value(double drawn) const noexcept {
            return codes.empty() ? si * drawn : codes[static_cast<size_t>(drawn)];
        }
    };
    struct Levels {
        int slot;
        /// Level in each condition or, if `of_round`, in each round.
        std::vector<double> levels;
        bool of_round = false;
    };
    std::vector<Draw> draws;
    std::vector<Levels> factors;
    struct Changing {
        int slot = 0;
        int between = 0;  ///< slot of the variable in TaskPlan::between
    };
    std::vector<Changing> variables;
    int outcome = 0;
    std::vector<double> outcomes;  ///< code of the name of each outcome
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
