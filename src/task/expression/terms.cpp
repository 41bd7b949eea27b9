#include "task/expression/terms.h"

#include <array>
#include <cmath>

#include "base/choices.h"

namespace dihaptic::task {
namespace {

constexpr std::array kWords{"and", "or", "not", "if", "else"};

}  // namespace

Terms::Value Terms::primary() {
    const Token& first = token();
    ++at_;
    switch (first.kind) {
        case Token::Kind::number:
            return with_unit(first);
        case Token::Kind::quoted: {
            const int index = quantities_.text(first.text);
            return {Type::text, {}, true, {constant(index), -1, -1}, first.column, nullptr};
        }
        case Token::Kind::name:
            if (is_word(first.text)) break;
            return token().is("(") ? call(first) : quantity(first);
        case Token::Kind::symbol:
            if (first.text != "(") break;
            {
                Value inner = choice();
                expect(")");
                return inner;
            }
        case Token::Kind::end:
            --at_;
            throw Fault{first.column, "the expression ends where a value is expected",
                        "Complete the expression."};
    }
    throw Fault{first.column, fmt::format("'{}' is given where a value is expected", first.text),
                "Write a number, a name or a bracket."};
}

bool Terms::is_word(std::string_view text) {
    return std::find(kWords.begin(), kWords.end(), text) != kWords.end();
}

Terms::Value Terms::with_unit(const Token& first) {
    double value = first.value;
    if (!is_unit(token())) return number(constant(value), {}, first.column, true);
    Dimension dimension;
    bool over = false;
    while (true) {
        const auto unit = *find_unit_in_si(token().text);
        ++at_;
        const int power = unit_power();
        for (int i = 0; i < power; ++i) {
            value = over ? value / unit.si : in_si(value, unit.si);
            dimension = over ? dimension / unit.dimension : dimension * unit.dimension;
        }
        if (!unit_goes_on()) break;
        over = token().is("/");
        ++at_;
    }
    return number(constant(value), dimension, first.column);
}

double Terms::in_si(double value, double unit) {
    const double parts = std::round(1 / unit);
    return parts > 1 && unit == 1 / parts ? value / parts : value * unit;
}

bool Terms::is_unit(const Token& word) {
    return word.kind == Token::Kind::name && find_unit_in_si(word.text).has_value();
}

bool Terms::unit_goes_on() const {
    return (token().is("*") || token().is("/")) && is_unit(next()) &&
           !quantities_.knows(next().text);
}

int Terms::unit_power() {
    if (!token().is("^") || next().kind != Token::Kind::number) return 1;
    const double power = next().value;
    if (power != std::round(power) || power < 1 || power > 9) return 1;
    at_ += 2;
    return static_cast<int>(power);
}

Terms::Value Terms::quantity(const Token& name) {
    const auto symbol = quantities_.find(name.text);
    if (!symbol) throw unknown(name);
    note(symbol->kind);
    Value out;
    out.column = name.column;
    out.dimension = symbol->dimension;
    out.node[0] = slot(symbol->slot);
    if (symbol->type == Symbol::Type::text) {
        out.type = Type::text;
        out.levels = quantities_.levels(symbol->slot);
    }
    if (symbol->type == Symbol::Type::vector) {
        out.type = Type::vector;
        out.node[1] = slot(symbol->slot + 1);
        out.node[2] = slot(symbol->slot + 2);
    }
    return out;
}

Fault Terms::unknown(const Token& name) const {
    if (find_unit_in_si(name.text))
        return {name.column, fmt::format("'{}' is a unit", name.text),
                fmt::format("Write it after a number: 1 {}.", name.text)};
    if (quantities_.has_level(name.text))
        return {name.column, fmt::format("'{}' is not a quantity, but a text", name.text),
                fmt::format("Put texts in quotes: \"{}\".", name.text)};
    const std::vector<std::string> names = quantities_.names();
    const std::string guess = nearest(name.text, names);
    return {name.column, fmt::format("'{}' is not a quantity", name.text),
            guess.empty() ? "docs/files/expressions.md says which names there are."
                          : fmt::format("Did you mean {}?", guess),
            names};
}

Terms::Value Terms::of_thing(const std::string& thing, const std::string& member, size_t column) {
    Token name;
    name.kind = Token::Kind::name;
    name.text = member.empty() ? thing : thing + "." + member;
    name.column = column;
    return quantity(name);
}

}  // namespace dihaptic::task
