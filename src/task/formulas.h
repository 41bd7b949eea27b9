// The formulas of a task (base/formula.h), compiled once for its plan.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/formula.h"
#include "task/expression.h"
#include "task/quantities.h"

namespace dihaptic::task {

struct CompiledFormula {
    Formula formula;  ///< its text, with its key, unit, bounds and place
    Expression expression;
    double scale = 1;    ///< unit of the key if the text has no dimension
    double largest = 0;  ///< over the planned trials

    double value(std::span<const double> values) const noexcept {
        return scale * expression(values);
    }
};

/// A visitor (base/field.h) that calls f(Formula&) with each formula of a struct.
template <class F>
class FormulaVisitor {
  public:
    explicit FormulaVisitor(F f) : f_(std::move(f)) {}

    template <class T>
    void operator()(std::string_view, T& value, Field = {}) {
        look_into(value);
    }

  private:
    void look_into(Formula& value) { f_(value); }
    void look_into(FormulaVec3& value) {
        for (Formula& component : value) f_(component);
    }
    template <class T>
    void look_into(T& value) {
        if constexpr (Described<T, FormulaVisitor>) value.visit(*this);
    }
    template <class T>
    void look_into(std::optional<T>& value) {
        if (value) look_into(*value);
    }
    template <class T>
    void look_into(std::vector<T>& values) {
        for (T& value : values) look_into(value);
    }

    F f_;
};

template <class Struct, class F>
void each_formula(Struct& value, F f) {
    FormulaVisitor visitor(std::move(f));
    value.visit(visitor);
}

}  // namespace dihaptic::task
