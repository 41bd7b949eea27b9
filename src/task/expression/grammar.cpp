#include "task/expression/grammar.h"

#include <fmt/ranges.h>

#include <array>

#include "base/choices.h"

namespace dihaptic::task {
namespace {

constexpr int kDeepestText = 40;  // maximum nesting depth of brackets

}  // namespace

void Grammar::expect(std::string_view symbol) {
    if (!take(symbol))
        throw Fault{token().column, fmt::format("'{}' is missing", symbol), "Add it."};
}

std::string Grammar::shown(const Token& token) {
    return token.kind == Token::Kind::number ? fmt::format("{}", token.value) : token.text;
}

Grammar::Value Grammar::choice() {
    if (++depth_ > kDeepestText)
        throw Fault{token().column, "has too many nested brackets", "Simplify it."};
    Value a = either();
    if (token().is("if")) {
        const size_t column = token().column;
        ++at_;
        const Value condition = either();
        demand(condition, Type::truth);
        expect("else");
        Value b = choice();
        if (a.type != b.type)
            throw Fault{column, fmt::format("is either {} or {}", what(a), what(b)),
                        "Give both branches the same kind of value."};
        match(a, b, column);
        a.literal = a.literal && a.type == Type::number;
        if (a.levels != b.levels) a.levels = nullptr;
        for (size_t i = 0; i < (a.type == Type::vector ? 3u : 1u); ++i)
            a.node[i] = apply(kSelect, {a.node[i], condition.node[0], b.node[i]});
    }
    --depth_;
    return a;
}

Grammar::Value Grammar::either() {
    Value a = both();
    while (token().is("or")) a = logical(kOr, a, &Grammar::both);
    return a;
}

Grammar::Value Grammar::both() {
    Value a = negation();
    while (token().is("and")) a = logical(kAnd, a, &Grammar::negation);
    return a;
}

Grammar::Value Grammar::logical(const Operation& operation, const Value& a,
                                Value (Grammar::*side)()) {
    ++at_;
    const Value b = (this->*side)();
    demand(a, Type::truth);
    demand(b, Type::truth);
    return truth(apply(operation, a.node[0], b.node[0]), a.column);
}

Grammar::Value Grammar::negation() {
    const size_t column = token().column;
    int times = 0;
    while (take("not")) ++times;
    Value a = comparison();
    if (times == 0) return a;
    demand(a, Type::truth);
    return times % 2 == 0 ? a : truth(apply(kNot, {a.node[0], -1, -1}), column);
}

const Operation* Grammar::comparator() const {
    static constexpr std::array<std::pair<std::string_view, const Operation*>, 6> kOperators{
        {{"<", &kLess},
         {"<=", &kAtMost},
         {">", &kMore},
         {">=", &kAtLeast},
         {"==", &kEqual},
         {"!=", &kUnequal}}};
    for (const auto& [symbol, operation] : kOperators) {
        if (token().is(symbol)) return operation;
    }
    return nullptr;
}

Grammar::Value Grammar::comparison() {
    Value a = sum();
    if (comparator() == nullptr) return a;
    const size_t begin = a.column;
    int all = -1;
    while (const Operation* operation = comparator()) {
        const size_t column = token().column;
        ++at_;
        Value b = sum();
        check_comparison(a, b, operation == &kEqual || operation == &kUnequal, column);
        const int one = apply(*operation, a.node[0], b.node[0]);
        all = all < 0 ? one : apply(kAnd, all, one);
        a = b;
    }
    return truth(all, begin);
}

void Grammar::check_comparison(Value& a, Value& b, bool equality, size_t column) {
    if (a.type != b.type || a.type == Type::vector) {
        throw Fault{column, fmt::format("one side is {}, but the other is {}", what(a), what(b)),
                    "Compare numbers with numbers, and texts with quoted texts."};
    }
    if (a.type != Type::number && !equality)
        throw Fault{column, fmt::format("each side is {}, not a number", what(a)),
                    "Use only == and !=."};
    if (a.type == Type::text) check_levels(a, b);
    if (a.type == Type::text) check_levels(b, a);
    match(a, b, column);
}

void Grammar::check_levels(const Value& quoted, const Value& other) const {
    if (!quoted.literal || other.levels == nullptr) return;
    const std::string& text = quantities_.text(static_cast<int>(constant_of(quoted.node[0])));
    const auto& levels = *other.levels;
    if (std::find(levels.begin(), levels.end(), text) != levels.end()) return;
    const std::string guess = nearest(text, levels);
    throw Fault{quoted.column, fmt::format("the other side is never \"{}\"", text),
                guess.empty() ? fmt::format("Possible: {}.", fmt::join(levels, ", "))
                              : fmt::format("Did you mean \"{}\"?", guess),
                levels};
}

Grammar::Value Grammar::sum() {
    Value a = product();
    while (token().is("+") || token().is("-")) {
        const Operation& operation = token().is("+") ? kAdd : kSubtract;
        const size_t column = token().column;
        ++at_;
        Value b = product();
        if (a.type != Type::vector || b.type != Type::vector) {
            demand(a, Type::number);
            demand(b, Type::number);
        }
        a = joined(operation, a, b, column);
    }
    return a;
}

Grammar::Value Grammar::product() {
    Value a = signed_value();
    while (token().is("*") || token().is("/") || token().is("%")) {
        const std::string symbol = token().text;
        const size_t column = token().column;
        ++at_;
        Value b = signed_value();
        if (symbol == "%") {
            demand(a, Type::number);
            demand(b, Type::number);
            a = joined(kRemainder, a, b, column);
        } else {
            a = symbol == "*" ? multiplied(a, b) : divided(a, b);
        }
    }
    return a;
}

Grammar::Value Grammar::multiplied(Value a, Value b) {
    if (b.type == Type::vector) std::swap(a, b);
    demand(b, Type::number);
    if (a.type != Type::vector) demand(a, Type::number);
    return scaled(kMultiply, a, b, a.dimension * b.dimension);
}

Grammar::Value Grammar::divided(const Value& a, const Value& b) {
    demand(b, Type::number);
    if (a.type != Type::vector) demand(a, Type::number);
    if (is_constant(b.node[0]) && constant_of(b.node[0]) == 0)
        throw Fault{b.column, "is zero, by which nothing can be divided",
                    "Divide by another number."};
    return scaled(kDivide, a, b, a.dimension / b.dimension);
}

Grammar::Value Grammar::signed_value() {
    const size_t column = token().column;
    if (take("+")) return nested(&Grammar::signed_value);
    if (!take("-")) return power();
    Value a = nested(&Grammar::signed_value);
    if (a.type != Type::vector) demand(a, Type::number);
    for (size_t i = 0; i < (a.type == Type::vector ? 3u : 1u); ++i)
        a.node[i] = apply(kNegate, {a.node[i], -1, -1});
    a.column = column;
    return a;
}

Grammar::Value Grammar::nested(Value (Grammar::*part)()) {
    if (++depth_ > kDeepestText)
        throw Fault{token().column, "has too many signs in a row", "Simplify it."};
    const Value out = (this->*part)();
    --depth_;
    return out;
}

Grammar::Value Grammar::power() {
    Value base = primary();
    if (!token().is("^")) return base;
    ++at_;
    Value exponent = nested(&Grammar::signed_value);
    demand(base, Type::number);
    demand_pure(exponent);
    if (!(base.dimension == Dimension{})) base.dimension = raised(base, exponent);
    base.literal = base.literal && exponent.literal;
    base.node[0] = apply(kPower, base.node[0], exponent.node[0]);
    return base;
}

}  // namespace dihaptic::task
