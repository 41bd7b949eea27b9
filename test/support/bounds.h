// A visitor (base/field.h) that finds the numbers of a settings struct that lack a bound: a
// number that a file may set without limit ends in a diverging simulation, or in an excessive force
// on the hand.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <optional>
#include <string>
#include <typeinfo>
#include <vector>

#include "base/field.h"
#include "base/formula.h"
#include "base/geometry.h"
#include "base/node.h"

namespace dihaptic::testing {

class BoundsFinder {
  public:
    int numbers = 0;                     ///< count of numbers visited
    std::vector<std::string> unbounded;  ///< paths of numbers without two finite bounds

    void operator()(std::string_view name, double&, Field field = {}) { number(name, field); }
    void operator()(std::string_view name, int&, Field field = {}) { number(name, field); }
    void operator()(std::string_view name, Vec3&, Field field = {}) { number(name, field); }
    void operator()(std::string_view name, Formula&, Field field = {}) { number(name, field); }
    void operator()(std::string_view name, std::optional<Formula>&, Field field = {}) {
        number(name, field);
    }
    void operator()(std::string_view name, FormulaVec3&, Field field = {}) { number(name, field); }
    void operator()(std::string_view name, std::optional<FormulaVec3>&, Field field = {}) {
        number(name, field);
    }
    void operator()(std::string_view name, Mat3&, Field field = {}) { number(name, field); }
    void operator()(std::string_view name, std::optional<double>&, Field field = {}) {
        number(name, field);
    }
    void operator()(std::string_view name, std::optional<Vec3>&, Field field = {}) {
        number(name, field);
    }
    void operator()(std::string_view name, std::vector<double>&, Field field = {}) {
        number(name, field);
    }
    void operator()(std::string_view, bool&, Field = {}) {}
    void operator()(std::string_view, std::string&, Field = {}) {}
    void operator()(std::string_view, std::vector<std::string>&, Field = {}) {}
    void operator()(std::string_view, Node&, Field = {}) {}
    template <NamedEnum E>
    void operator()(std::string_view, E&, Field = {}) {}
    template <NamedEnum E>
    void operator()(std::string_view, std::optional<E>&, Field = {}) {}

    template <class Struct>
    requires Described<Struct, BoundsFinder>
    void operator()(std::string_view name, Struct& value, Field = {}) {
        const std::string outer = path_;
        path_ += std::string(name) + ".";
        value.visit(*this);
        path_ = outer;
    }
    template <class Struct>
    requires Described<Struct, BoundsFinder>
    void operator()(std::string_view name, std::optional<Struct>&, Field = {}) {
        Struct value{};
        (*this)(name, value);
    }
    template <class Struct>
    requires Described<Struct, BoundsFinder>
    void operator()(std::string_view name, std::vector<Struct>&, Field = {}) {
        Struct value{};
        (*this)(name, value);
    }

  private:
    void number(std::string_view name, const Field& field) {
        ++numbers;
        if (!std::isfinite(field.min) || !std::isfinite(field.max) || field.min >= field.max)
            unbounded.push_back(path_ + std::string(name));
    }

    std::string path_;
};

/// Expects that a settings struct has numbers, and that each of them has two bounds.
template <class Struct>
void expect_bounds(Struct value = {}) {
    BoundsFinder finder;
    finder("", value);
    EXPECT_GT(finder.numbers, 0);
    for (const std::string& path : finder.unbounded)
        ADD_FAILURE() << path << " of " << typeid(Struct).name() << " lacks a bound";
}

}  // namespace dihaptic::testing
