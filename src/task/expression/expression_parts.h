// Parts builds an expression from its parts after checking that they fit together, and writes its
// program. Constant parts are evaluated immediately.
#pragma once

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "base/unit.h"
#include "task/expression/expression.h"
#include "task/expression/expression_text.h"
#include "task/expression/operations.h"

namespace dihaptic::task {

class Parts {
  protected:
    enum class Type { number, truth, text, vector };
    /// A part of the expression.
    struct Value {
        Type type = Type::number;
        Dimension dimension;
        // a number that takes the other operand's dimension, or a quoted text
        bool literal = false;
        std::array<int, 3> node{
            -1, -1,
            -1};  // the node of each component of a vector; otherwise only the first is used
        size_t column = 1;
        const std::vector<std::string>* levels = nullptr;  // possible values of a text
    };
    struct Node {
        Operation operation{0, nullptr};  // has no function if the node is a slot or a constant
        std::array<int, 3> arguments{-1, -1, -1};
        int slot = -1;
        double value = 0;
    };

    int constant(double value) {
        nodes_.push_back({.value = value});
        return static_cast<int>(nodes_.size()) - 1;
    }
    int slot(int slot) {
        nodes_.push_back({.slot = slot});
        return static_cast<int>(nodes_.size()) - 1;
    }
    bool is_constant(int node) const {
        const Node& n = nodes_[static_cast<size_t>(node)];
        return n.operation.function == nullptr && n.slot < 0;
    }
    /// Returns the slot that the node reads, or -1 if the node is computed or a constant.
    int slot_in(int node) const {
        const Node& n = nodes_[static_cast<size_t>(node)];
        return n.operation.function == nullptr ? n.slot : -1;
    }
    double constant_of(int node) const { return nodes_[static_cast<size_t>(node)].value; }
    int apply(const Operation& operation, std::array<int, 3> arguments) {
        std::array<double, 3> values{};
        bool known = true;
        for (size_t i = 0; i < static_cast<size_t>(operation.arguments); ++i) {
            known = known && is_constant(arguments[i]);
            if (known) values[i] = constant_of(arguments[i]);
        }
        if (known) {
            const double value = operation.function(values.data());
            if (std::isnan(value))  // an infinite bound may be meant
                throw Fault{1, "has a part, made of numbers alone, that is not a number",
                            "Correct these numbers."};
            return constant(value);
        }
        nodes_.push_back({operation, arguments});
        return static_cast<int>(nodes_.size()) - 1;
    }
    int apply(const Operation& operation, int a, int b) { return apply(operation, {a, b, -1}); }
    Expression expression_of(int node) const {
        Expression out;
        emit(node, 0, out.program_);
        return out;
    }

    static std::string what(const Value& value) {
        if (value.type == Type::truth) return "true or false";
        if (value.type == Type::text) return "a text";
        if (value.type == Type::vector) return "a vector";
        const std::string unit = si_symbol(value.dimension);
        return unit == "1" ? "a pure number" : fmt::format("in {}", unit);
    }
    static void demand(const Value& value, Type type) {
        if (value.type == type) return;
        throw Fault{value.column,
                    fmt::format("is {}, but must be {}", what(value),
                                type == Type::truth    ? "a condition"
                                : type == Type::vector ? "a vector"
                                                       : "a number"),
                    type == Type::truth    ? "Compare it, e.g. x > 2."
                    : type == Type::vector ? "Name a body, a finger, a hand or a region."
                                           : "Name a component (.x), or use norm(...) for a "
                                             "vector, and 1 if ... else 0 for a condition."};
    }
    /// Gives a number without a unit the dimension of the other number, then checks that their
    /// dimensions are equal.
    void match(Value& a, Value& b, size_t column) {
        if (a.literal) adopt(a, b.dimension);
        if (b.literal) adopt(b, a.dimension);
        a.literal = b.literal = a.literal && b.literal;
        if (a.dimension == b.dimension) return;
        throw Fault{
            column, fmt::format("one side is {}, but the other is {}", what(a), what(b)),
            "Give both sides the same dimension, and numbers their unit (5 mm, 200 ms, 2 N)."};
    }
    /// Gives `value` the dimension. Warns that, for example, 40 compared with a speed is 40 m/s,
    /// where 40 mm/s may have been meant.
    void adopt(Value& value, const Dimension& dimension) {
        value.dimension = dimension;
        if (value.type != Type::number || !is_constant(value.node[0])) return;
        const double size = constant_of(value.node[0]);
        for (const Scale& scale : kScales) {
            if (!(::dihaptic::dimension(scale.quantity) == dimension) ||
                std::abs(size) < scale.much)
                continue;
            remarks_.push_back(
                {value.column,
                 fmt::format("{} has no unit and is read in {}", size, si_symbol(dimension)),
                 fmt::format("Write its unit after it, as in {} {}.", size, scale.unit),
                 {}});
        }
    }
    static void demand_pure(Value& value) {
        demand(value, Type::number);
        if (value.dimension == Dimension{}) return;
        throw Fault{value.column, fmt::format("is {}, but must be a pure number", what(value)),
                    fmt::format("Divide it by a unit: x / (1 {}).", si_symbol(value.dimension))};
    }
    Value number(int node, const Dimension& dimension, size_t column, bool literal = false) {
        return {Type::number, dimension, literal, {node, -1, -1}, column, nullptr};
    }
    Value truth(int node, size_t column) {
        return {Type::truth, {}, false, {node, -1, -1}, column, nullptr};
    }

    /// Combines two numbers or two vectors, which must have the same dimension.
    Value joined(const Operation& operation, Value a, Value b, size_t column) {
        match(a, b, column);
        for (size_t i = 0; i < (a.type == Type::vector ? 3u : 1u); ++i)
            a.node[i] = apply(operation, a.node[i], b.node[i]);
        return a;
    }
    Value scaled(const Operation& operation, Value a, const Value& b, const Dimension& dimension) {
        a.literal = a.literal && b.literal;
        a.dimension = dimension;
        for (size_t i = 0; i < (a.type == Type::vector ? 3u : 1u); ++i)
            a.node[i] = apply(operation, a.node[i], b.node[0]);
        return a;
    }
    Value length(const Value& vector, size_t column) {
        return number(apply(kNorm, vector.node), vector.dimension, column);
    }
    /// Returns the dimension of a power or a root.
    Dimension raised(const Value& base, const Value& exponent) const {
        if (!is_constant(exponent.node[0]))
            throw Fault{exponent.column,
                        fmt::format("the base is {}, but the exponent varies", what(base)),
                        "Write a number as the exponent."};
        return raised(base, constant_of(exponent.node[0]));
    }
    static Dimension raised(const Value& base, double power) {
        const auto times = [&](int exponent) {
            const double out = exponent * power;
            if (out != std::round(out) || std::abs(out) > 100)
                throw Fault{base.column,
                            fmt::format("is {}, and this root or power of it has no valid unit",
                                        what(base)),
                            fmt::format("Divide it by a unit first: x / (1 {}).",
                                        si_symbol(base.dimension))};
            return static_cast<int>(out);
        };
        return {times(base.dimension.m), times(base.dimension.kg), times(base.dimension.s)};
    }

    std::vector<Fault> remarks_;  // warnings about text that is valid but probably not intended

  private:
    static constexpr size_t kLongestProgram = 1000;  // maximum number of steps

    /// A quantity that is often given in a smaller unit, and a value of it that is too large for
    /// hand movements.
    struct Scale {
        Quantity quantity;
        double much;  // [SI]
        const char* unit;
    };
    static constexpr std::array<Scale, 4> kScales{{{Quantity::length, 5, "mm"},
                                                   {Quantity::speed, 10, "mm/s"},
                                                   {Quantity::mass, 20, "g"},
                                                   {Quantity::time, 200, "ms"}}};

    /// Appends to `out` the program of a node whose value will be at `depth` above the bottom of
    /// the stack.
    void emit(int node, size_t depth, std::vector<Expression::Step>& out) const {
        const Node& n = nodes_[static_cast<size_t>(node)];
        if (depth >= Expression::kDeepest || out.size() >= kLongestProgram)
            throw Fault{1, "is too long", "Split it into several variables."};
        for (size_t i = 0; i < static_cast<size_t>(n.operation.arguments); ++i)
            emit(n.arguments[i], depth + i, out);
        out.push_back({n.operation.function, n.operation.arguments, n.slot, n.value});
    }

    std::vector<Node> nodes_;
};

}  // namespace dihaptic::task
