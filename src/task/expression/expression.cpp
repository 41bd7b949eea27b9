#include "task/expression/expression.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "base/choices.h"
#include "task/expression/expression_parts.h"

namespace dihaptic::task {
namespace {

constexpr size_t kLongestText = 2000;
constexpr int kDeepestText = 40;  // maximum nesting depth of brackets

constexpr std::array kWords{"and", "or", "not", "if", "else"};

}  // namespace

/// Parses the text by operator precedence, checks the types of its parts, and builds the program.
/// Throws Fault if the text contains a mistake.
class Compiler : Parts {
  public:
    using Parts::remarks_;

    Compiler(std::string_view text, Quantities& quantities)
        : quantities_(quantities), tokens_(tokens_of(text)) {}

    Expression compile() {
        const Value value = choice();
        if (token().kind != Token::Kind::end)
            throw Fault{token().column, fmt::format("'{}' is not expected here", shown(token())),
                        "Write an operator before this, or leave it out."};
        if (value.type == Type::vector)
            throw Fault{value.column, "is a vector", "Name a component (.x), or write norm(...)."};
        Expression out;
        emit(value.node[0], 0, out.program_);
        out.type_ = value.type == Type::truth  ? Expression::Type::truth
                    : value.type == Type::text ? Expression::Type::text
                                               : Expression::Type::number;
        out.dimension_ = value.dimension;
        out.latest_ = latest_;
        if (!look_backs_.empty())
            out.look_backs_ = std::make_shared<const std::vector<LookBack>>(look_backs_);
        return out;
    }

  private:
    // tokens

    const Token& token() const { return tokens_[at_]; }
    const Token& next() const { return tokens_[std::min(at_ + 1, tokens_.size() - 1)]; }
    bool take(std::string_view symbol) {
        if (!token().is(symbol)) return false;
        ++at_;
        return true;
    }
    void expect(std::string_view symbol) {
        if (!take(symbol))
            throw Fault{token().column, fmt::format("'{}' is missing", symbol), "Add it."};
    }
    static std::string shown(const Token& token) {
        return token.kind == Token::Kind::number ? fmt::format("{}", token.value) : token.text;
    }

    // grammar rules, starting with the operators of lowest precedence

    Value choice() {
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

    Value either() {
        Value a = both();
        while (token().is("or")) a = logical(kOr, a, &Compiler::both);
        return a;
    }
    Value both() {
        Value a = negation();
        while (token().is("and")) a = logical(kAnd, a, &Compiler::negation);
        return a;
    }
    Value logical(const Operation& operation, const Value& a, Value (Compiler::*side)()) {
        ++at_;
        const Value b = (this->*side)();
        demand(a, Type::truth);
        demand(b, Type::truth);
        return truth(apply(operation, a.node[0], b.node[0]), a.column);
    }
    Value negation() {
        const size_t column = token().column;
        int times = 0;
        while (take("not")) ++times;
        Value a = comparison();
        if (times == 0) return a;
        demand(a, Type::truth);
        return times % 2 == 0 ? a : truth(apply(kNot, {a.node[0], -1, -1}), column);
    }

    const Operation* comparator() const {
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
    /// Parses a chain of comparisons: a < b <= c means a < b and b <= c.
    Value comparison() {
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
    void check_comparison(Value& a, Value& b, bool equality, size_t column) {
        if (a.type != b.type || a.type == Type::vector) {
            throw Fault{column,
                        fmt::format("one side is {}, but the other is {}", what(a), what(b)),
                        "Compare numbers with numbers, and texts with quoted texts."};
        }
        if (a.type != Type::number && !equality)
            throw Fault{column, fmt::format("each side is {}, not a number", what(a)),
                        "Use only == and !=."};
        if (a.type == Type::text) check_levels(a, b);
        if (a.type == Type::text) check_levels(b, a);
        match(a, b, column);
    }
    /// Checks that a quoted text is one of the possible values of the other operand.
    void check_levels(const Value& quoted, const Value& other) const {
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

    Value sum() {
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
    Value product() {
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
    Value multiplied(Value a, Value b) {
        if (b.type == Type::vector) std::swap(a, b);
        demand(b, Type::number);
        if (a.type != Type::vector) demand(a, Type::number);
        return scaled(kMultiply, a, b, a.dimension * b.dimension);
    }
    Value divided(const Value& a, const Value& b) {
        demand(b, Type::number);
        if (a.type != Type::vector) demand(a, Type::number);
        if (is_constant(b.node[0]) && constant_of(b.node[0]) == 0)
            throw Fault{b.column, "is zero, by which nothing can be divided",
                        "Divide by another number."};
        return scaled(kDivide, a, b, a.dimension / b.dimension);
    }
    Value signed_value() {
        const size_t column = token().column;
        if (take("+")) return nested(&Compiler::signed_value);
        if (!take("-")) return power();
        Value a = nested(&Compiler::signed_value);
        if (a.type != Type::vector) demand(a, Type::number);
        for (size_t i = 0; i < (a.type == Type::vector ? 3u : 1u); ++i)
            a.node[i] = apply(kNegate, {a.node[i], -1, -1});
        a.column = column;
        return a;
    }
    Value nested(Value (Compiler::*part)()) {
        if (++depth_ > kDeepestText)
            throw Fault{token().column, "has too many signs in a row", "Simplify it."};
        const Value out = (this->*part)();
        --depth_;
        return out;
    }

    Value power() {
        Value base = primary();
        if (!token().is("^")) return base;
        ++at_;
        Value exponent = nested(&Compiler::signed_value);
        demand(base, Type::number);
        demand_pure(exponent);
        if (!(base.dimension == Dimension{})) base.dimension = raised(base, exponent);
        base.literal = base.literal && exponent.literal;
        base.node[0] = apply(kPower, base.node[0], exponent.node[0]);
        return base;
    }
    Value primary() {
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
        throw Fault{first.column,
                    fmt::format("'{}' is given where a value is expected", first.text),
                    "Write a number, a name or a bracket."};
    }
    static bool is_word(std::string_view text) {
        return std::find(kWords.begin(), kWords.end(), text) != kWords.end();
    }

    /// Parses a number with an optional unit: 5 mm, 20 mm/s, 9.81 m/s^2.
    Value with_unit(const Token& first) {
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
    /// Converts the value to the SI unit. If the unit is an integer fraction of the SI unit, the
    /// number is divided, so that 700 ms is exactly the double 0.7.
    static double in_si(double value, double unit) {
        const double parts = std::round(1 / unit);
        return parts > 1 && unit == 1 / parts ? value / parts : value * unit;
    }
    static bool is_unit(const Token& word) {
        return word.kind == Token::Kind::name && find_unit_in_si(word.text).has_value();
    }
    /// Whether a unit continues with another unit, i.e. one that is not also the name of a
    /// quantity.
    bool unit_goes_on() const {
        return (token().is("*") || token().is("/")) && is_unit(next()) &&
               !quantities_.knows(next().text);
    }
    int unit_power() {
        if (!token().is("^") || next().kind != Token::Kind::number) return 1;
        const double power = next().value;
        if (power != std::round(power) || power < 1 || power > 9) return 1;
        at_ += 2;
        return static_cast<int>(power);
    }

    Value quantity(const Token& name) {
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
    void note(Kind kind) { latest_ = std::max(latest_, kind); }
    Fault unknown(const Token& name) const {
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

    // functions

    Value call(const Token& name) {
        ++at_;  // the bracket
        for (const NamedFunction& function : kFunctions) {
            if (function.name == name.text) return call(name, function);
        }
        if (name.text == "norm" || name.text == "distance" || name.text == "dot")
            return call_on_vectors(name);
        for (const ShortForm& form : kShortForms) {
            if (form.name == name.text) {
                const Value out = (this->*form.read)(name);
                expect(")");
                return out;
            }
        }
        std::vector<std::string> known{"norm", "distance", "dot"};
        for (const NamedFunction& function : kFunctions) known.emplace_back(function.name);
        for (const ShortForm& form : kShortForms) known.emplace_back(form.name);
        const std::string guess = nearest(name.text, known);
        throw Fault{name.column, fmt::format("'{}' is not a function", name.text),
                    guess.empty() ? fmt::format("Known: {}.", fmt::join(known, ", "))
                                  : fmt::format("Did you mean {}?", guess),
                    known};
    }
    std::vector<Value> arguments(const Token& name, int least, int most) {
        std::vector<Value> out;
        if (!token().is(")")) {
            do out.push_back(choice());
            while (take(","));
        }
        expect(")");
        const auto count = static_cast<int>(out.size());
        if (count < least || count > most)
            throw Fault{
                name.column,
                fmt::format("{} has {} argument{}", name.text, count, count == 1 ? "" : "s"),
                least == most ? fmt::format("It needs {}.", least)
                              : fmt::format("It needs at least {}.", least)};
        return out;
    }
    Value call(const Token& name, const NamedFunction& function) {
        std::vector<Value> all = arguments(name, function.least, function.most);
        for (Value& value : all) demand(value, Type::number);
        for (size_t i = 1; i < all.size(); ++i) match(all[i - 1], all[i], all[i].column);
        // numbers without a unit may precede the first number with a unit
        for (size_t i = all.size() - 1; i > 0; --i) match(all[i - 1], all[i], all[i].column);
        Value out = all.front();
        out.column = name.column;
        for (const Value& value : all) out.literal = out.literal && value.literal;
        if (function.takes == Takes::pure) demand_pure(all.front());
        if (function.takes == Takes::root) out.dimension = raised(all.front(), 0.5);
        if (function.takes == Takes::any) out.dimension = {};
        std::array<int, 3> nodes{-1, -1, -1};
        const auto taken = static_cast<size_t>(function.operation.arguments);
        for (size_t i = 0; i < taken; ++i) nodes[i] = all[i].node[0];
        out.node[0] = apply(function.operation, nodes);
        for (size_t i = taken; i < all.size(); ++i)  // min and max take any number of arguments
            out.node[0] = apply(function.operation, out.node[0], all[i].node[0]);
        return out;
    }
    /// Resolves a quoted text where only the name of a body, a finger, a hand or a region is
    /// possible.
    Value named(const Value& value) {
        if (value.type != Type::text || !value.literal) return value;
        const std::string text = quantities_.text(static_cast<int>(constant_of(value.node[0])));
        if (!quantities_.thing(text) && !quantities_.region(text)) return value;
        return of_thing(text, "", value.column);
    }
    Value call_on_vectors(const Token& name) {
        const int count = name.text == "norm" ? 1 : 2;
        std::vector<Value> all = arguments(name, count, count);
        for (Value& value : all) {
            value = named(value);
            demand(value, Type::vector);
        }
        if (name.text == "norm") return length(all[0], name.column);
        if (name.text == "distance")
            return length(joined(kSubtract, all[0], all[1], all[1].column), name.column);
        std::array<int, 3> products{};
        for (size_t i = 0; i < 3; ++i)
            products[i] = apply(kMultiply, all[0].node[i], all[1].node[i]);
        return number(apply(kAdd, apply(kAdd, products[0], products[1]), products[2]),
                      all[0].dimension * all[1].dimension, name.column);
    }
    // short forms of conditions, which take names as arguments

    struct ShortForm {
        std::string_view name;
        Value (Compiler::*read)(const Token&);
    };
    static constexpr size_t kShortFormCount = 13;
    static const std::array<ShortForm, kShortFormCount> kShortForms;

    bool ends_arguments() const { return token().is(")"); }
    std::string name_argument(const char* wanted) {
        const Token& name = token();
        if (name.kind != Token::Kind::name && name.kind != Token::Kind::quoted)
            throw Fault{name.column, fmt::format("{} is missing", wanted), "Add its name."};
        ++at_;
        return name.text;
    }
    [[noreturn]] static void throw_unknown(size_t column, const std::string& name,
                                           const char* wanted,
                                           const std::vector<std::string>& known) {
        const std::string guess = nearest(name, known);
        throw Fault{column, fmt::format("'{}' is not {}", name, wanted),
                    guess.empty() ? fmt::format("Known: {}.", fmt::join(known, ", "))
                                  : fmt::format("Did you mean {}?", guess),
                    known};
    }
    Quantities::Thing thing_argument() {
        const size_t column = token().column;
        const std::string name = name_argument("a body, a finger or a hand");
        const auto thing = quantities_.thing(name);
        if (!thing) throw_unknown(column, name, "a body, a finger or a hand", quantities_.things());
        thing_ = name;
        return *thing;
    }
    int body_argument() {
        const size_t column = token().column;
        const Quantities::Thing thing = thing_argument();
        if (thing.body >= 0) return thing.body;
        throw Fault{column, fmt::format("'{}' is not a body", thing_), "Name a body."};
    }
    scene::FingerSet fingers_argument() {
        if (!take(",")) return quantities_.thing("")->fingers;
        const size_t column = token().column;
        const Quantities::Thing thing = thing_argument();
        if (thing.body < 0) return thing.fingers;
        throw Fault{column, fmt::format("'{}' is neither a finger nor a hand", thing_),
                    "Name a finger or a hand, or leave the argument out."};
    }
    /// Parses a number that follows a comma; returns `value` if there is no comma.
    Value number_argument(double value, const Dimension& dimension) {
        if (!take(",")) return number(constant(value), dimension, token().column);
        Value out = choice();
        demand(out, Type::number);
        Value wanted = number(-1, dimension, out.column);
        match(out, wanted, out.column);
        return out;
    }
    /// Returns a vector that belongs to the thing: its position ("") or another member.
    Value of_thing(const std::string& thing, const std::string& member, size_t column) {
        Token name;
        name.kind = Token::Kind::name;
        name.text = member.empty() ? thing : thing + "." + member;
        name.column = column;
        return quantity(name);
    }

    /// Parses inside(thing, region); for index.shown, the displayed position is tested.
    Value inside(const Token& name) {
        constexpr std::string_view kShown = ".shown";
        std::string& first = tokens_[at_].text;
        const bool shown = first.ends_with(kShown);
        if (shown) first.resize(first.size() - kShown.size());
        thing_argument();
        const Value place = of_thing(thing_, shown ? "shown" : "", name.column);
        demand(place, Type::vector);
        expect(",");
        const size_t column = token().column;
        const std::string region = name_argument("a region");
        const auto at = quantities_.region(region);
        if (!at) throw_unknown(column, region, "a region", quantities_.regions());
        std::array<int, 3> arm{};
        for (size_t i = 0; i < 3; ++i)
            arm[i] = apply(kSubtract, place.node[i], slot(*at + static_cast<int>(i)));
        return truth(apply(kAtMost, apply(kNorm, arm), slot(*at + 3)), name.column);
    }
    Value outside(const Token& name) { return opposite(inside(name)); }
    Value touched(const Token& name) { return pressed(name, 1); }
    Value released(const Token& name) { return opposite(pressed(name, 1)); }
    Value gripped(const Token& name) { return pressed(name, 2); }
    Value opposite(Value value) {
        value.node[0] = apply(kNot, {value.node[0], -1, -1});
        return value;
    }
    /// Parses a condition that at least `fingers` fingers press a body.
    Value pressed(const Token& name, int fingers) {
        const int body = body_argument();
        const int count = slot(quantities_.pressing(body, fingers_argument()));
        note(Kind::tick);
        return truth(apply(kAtLeast, count, constant(fingers)), name.column);
    }
    Value lifted(const Token& name) {
        const int body = body_argument();
        const Value z = of_thing(thing_, "position.z", name.column);
        const int rise =
            apply(kSubtract, z.node[0], slot(quantities_.start(static_cast<size_t>(body)) + 2));
        const Value height = number_argument(0.02, dimension(Quantity::length));
        return truth(apply(kAtLeast, rise, height.node[0]), name.column);
    }
    Value still(const Token& name) {
        Quantities::Thing thing = *quantities_.thing("");
        std::string body;
        if (!ends_arguments() && token().kind != Token::Kind::symbol) {
            thing = thing_argument();
            body = thing_;
        }
        const Value limit = number_argument(0.02, dimension(Quantity::speed));
        if (thing.body >= 0) {
            const Value speed = length(of_thing(body, "velocity", name.column), name.column);
            return truth(apply(kLess, speed.node[0], limit.node[0]), name.column);
        }
        int all = constant(1);
        for (size_t i = 0; i < quantities_.fingers().size(); ++i) {
            if (!scene::contains(thing.fingers, i)) continue;
            const Value v = of_thing(quantities_.fingers()[i], "handle_velocity", name.column);
            const int one = apply(kLess, apply(kNorm, v.node), limit.node[0]);
            all = apply(kAnd, all, one);
        }
        return truth(all, name.column);
    }
    Value contact_force(const Token& name) {
        const Quantities::Thing a = thing_argument();
        expect(",");
        const Quantities::Thing b = thing_argument();
        note(Kind::tick);
        return number(slot(quantities_.contact_force(a, b)), dimension(Quantity::force),
                      name.column);
    }

    Value rate(const Token& name) {
        const Value of = choice();
        demand(of, Type::number);
        const int slot_of = of.type == Type::number ? slot_in(of.node[0]) : -1;
        const std::optional<int> rate = quantities_.rate(slot_of);
        if (!rate)
            throw Fault{name.column, "'rate' needs a single number that is measured in each tick",
                        "Write e.g. rate(grip_force) or rate(block.z)."};
        note(Kind::tick);
        return number(slot(*rate), of.dimension / dimension(Quantity::time), name.column);
    }

    Value mean(const Token& name) { return look_back(name, LookBack::Statistic::mean); }
    Value median(const Token& name) { return look_back(name, LookBack::Statistic::median); }
    Value sd(const Token& name) { return look_back(name, LookBack::Statistic::sd); }
    Value best(const Token& name) { return look_back(name, LookBack::Statistic::best); }
    Value look_back(const Token& name, LookBack::Statistic statistic) {
        if (!quantities_.looks_back()) {
            throw Fault{name.column, fmt::format("'{}' looks back over trials", name.text),
                        "In after_trial, set a variable to it, and use that variable here."};
        }
        const Value of = choice();
        demand(of, Type::number);
        LookBack out;
        out.statistic = statistic;
        if (token().is(",") || statistic != LookBack::Statistic::best)
            out.count = trials_argument(name);
        emit(of.node[0], 0, out.of.program_);
        out.slot = quantities_.define_unnamed(of.dimension).slot;
        look_backs_.push_back(out);
        note(Kind::figure);
        return number(slot(out.slot), of.dimension, name.column);
    }
    /// Parses the number of trials, which follows a comma.
    size_t trials_argument(const Token& name) {
        const size_t column = token().column;
        if (!take(","))
            throw Fault{column, "the number of trials is missing",
                        fmt::format("Write e.g. {}(x, 10).", name.text)};
        const Value count = choice();
        const double trials = count.type == Type::number && is_constant(count.node[0])
                                  ? constant_of(count.node[0])
                                  : 0;
        if (!(trials >= 1 && trials <= LookBack::kMost) || trials != std::floor(trials))
            throw Fault{column,
                        fmt::format("the number of trials must be a whole number from 1 to {}",
                                    LookBack::kMost),
                        fmt::format("Write e.g. {}(x, 10).", name.text)};
        return static_cast<size_t>(trials);
    }

    Quantities& quantities_;
    std::vector<LookBack> look_backs_;
    std::vector<Token> tokens_;
    size_t at_ = 0;
    int depth_ = 0;
    std::string thing_;  // name read by the last call of thing_argument()
    Kind latest_ = Kind::draw;
};

constexpr std::array<Compiler::ShortForm, Compiler::kShortFormCount> Compiler::kShortForms{{
    {"inside", &Compiler::inside},
    {"outside", &Compiler::outside},
    {"touched", &Compiler::touched},
    {"released", &Compiler::released},
    {"gripped", &Compiler::gripped},
    {"lifted", &Compiler::lifted},
    {"still", &Compiler::still},
    {"contact_force", &Compiler::contact_force},
    {"rate", &Compiler::rate},
    {"mean", &Compiler::mean},
    {"median", &Compiler::median},
    {"sd", &Compiler::sd},
    {"best", &Compiler::best},
}};

Expression Expression::compile(std::string_view text, Quantities& quantities, const Place& place,
                               std::string_view key, Diagnostics& diagnostics) {
    try {
        if (text.size() > kLongestText)
            throw Fault{kLongestText, "is too long", "Split it into several variables."};
        Compiler compiler(text, quantities);
        Expression out = compiler.compile();
        for (const Fault& remark : compiler.remarks_)
            diagnostics.warning(place, std::string(key),
                                fmt::format("column {}: {}", remark.column, remark.what),
                                remark.remedy);
        return out;
    } catch (const Fault& fault) {
        diagnostics.error(place, std::string(key),
                          fmt::format("column {}: {}", fault.column, fault.what), fault.remedy,
                          choices_of(fault.known));
        return {};
    }
}

const std::vector<LookBack>& Expression::look_backs() const {
    static const std::vector<LookBack> kNone;
    return look_backs_ ? *look_backs_ : kNone;
}

bool Expression::names(int slot) const {
    return std::any_of(program_.begin(), program_.end(), [&](const Step& step) {
        return step.function == nullptr && step.slot == slot;
    });
}

Expression Expression::compile_of(Quantity quantity, const char* what, std::string_view text,
                                  Quantities& quantities, const Place& place, std::string_view key,
                                  const std::string& example, Diagnostics& diagnostics) {
    if (text.empty()) return {};
    Expression out = compile(text, quantities, place, key, diagnostics);
    const bool fits =
        out.type() == Type::number && out.dimension() == ::dihaptic::dimension(quantity);
    if (out.empty() || fits || text == "0") return out;
    diagnostics.error(place, std::string(key),
                      fmt::format("'{}' does not have the dimension of {}", text, what), example);
    return {};
}

double Expression::operator()(std::span<const double> values) const noexcept {
    std::array<double, kDeepest + 1> stack{};
    double* top = stack.data();  // where the next value is stored
    for (const Step& step : program_) {
        if (step.function == nullptr) {
            *top++ = step.slot < 0 ? step.value : values[static_cast<size_t>(step.slot)];
        } else {
            top -= step.arguments;
            *top = step.function(top);
            ++top;
        }
    }
    return stack[0];
}

}  // namespace dihaptic::task
