#include "task/expression/expression.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <string>

#include "base/choices.h"
#include "task/expression/short_forms.h"

namespace dihaptic::task {
namespace {

constexpr size_t kLongestText = 2000;

}  // namespace

/// Compiles a whole text: parses function calls, and builds the program. Throws Fault if the text
/// contains a mistake.
class Compiler final : ShortForms {
  public:
    using Parts::remarks_;

    Compiler(std::string_view text, Quantities& quantities) : ShortForms(text, quantities) {}

    Expression compile() {
        const Value value = choice();
        if (token().kind != Token::Kind::end)
            throw Fault{token().column, fmt::format("'{}' is not expected here", shown(token())),
                        "Write an operator before this, or leave it out."};
        if (value.type == Type::vector)
            throw Fault{value.column, "is a vector", "Name a component (.x), or write norm(...)."};
        Expression out = expression_of(value.node[0]);
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
    Value call(const Token& name) final {
        ++at_;  // the bracket
        for (const NamedFunction& function : kFunctions) {
            if (function.name == name.text) return call(name, function);
        }
        if (name.text == "norm" || name.text == "distance" || name.text == "dot")
            return call_on_vectors(name);
        if (const std::optional<Value> form = short_form(name)) return *form;
        std::vector<std::string> known{"norm", "distance", "dot"};
        for (const NamedFunction& function : kFunctions) known.emplace_back(function.name);
        append_names(known);
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
};

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
