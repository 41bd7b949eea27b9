#include "task/expression/short_forms.h"

#include <fmt/ranges.h>

#include <cmath>

#include "base/choices.h"

namespace dihaptic::task {

constexpr std::array<ShortForms::ShortForm, ShortForms::kShortFormCount> ShortForms::kShortForms{{
    {"inside", &ShortForms::inside},
    {"outside", &ShortForms::outside},
    {"touched", &ShortForms::touched},
    {"released", &ShortForms::released},
    {"gripped", &ShortForms::gripped},
    {"lifted", &ShortForms::lifted},
    {"still", &ShortForms::still},
    {"contact_force", &ShortForms::contact_force},
    {"rate", &ShortForms::rate},
    {"mean", &ShortForms::mean},
    {"median", &ShortForms::median},
    {"sd", &ShortForms::sd},
    {"best", &ShortForms::best},
}};

std::optional<ShortForms::Value> ShortForms::short_form(const Token& name) {
    for (const ShortForm& form : kShortForms) {
        if (form.name != name.text) continue;
        const Value out = (this->*form.read)(name);
        expect(")");
        return out;
    }
    return std::nullopt;
}

void ShortForms::append_names(std::vector<std::string>& names) {
    for (const ShortForm& form : kShortForms) names.emplace_back(form.name);
}

std::string ShortForms::name_argument(const char* wanted) {
    const Token& name = token();
    if (name.kind != Token::Kind::name && name.kind != Token::Kind::quoted)
        throw Fault{name.column, fmt::format("{} is missing", wanted), "Add its name."};
    ++at_;
    return name.text;
}

void ShortForms::throw_unknown(size_t column, const std::string& name, const char* wanted,
                               const std::vector<std::string>& known) {
    const std::string guess = nearest(name, known);
    throw Fault{column, fmt::format("'{}' is not {}", name, wanted),
                guess.empty() ? fmt::format("Known: {}.", fmt::join(known, ", "))
                              : fmt::format("Did you mean {}?", guess),
                known};
}

Quantities::Thing ShortForms::thing_argument() {
    const size_t column = token().column;
    const std::string name = name_argument("a body, a finger or a hand");
    const auto thing = quantities_.thing(name);
    if (!thing) throw_unknown(column, name, "a body, a finger or a hand", quantities_.things());
    thing_ = name;
    return *thing;
}

int ShortForms::body_argument() {
    const size_t column = token().column;
    const Quantities::Thing thing = thing_argument();
    if (thing.body >= 0) return thing.body;
    throw Fault{column, fmt::format("'{}' is not a body", thing_), "Name a body."};
}

scene::FingerSet ShortForms::fingers_argument() {
    if (!take(",")) return quantities_.thing("")->fingers;
    const size_t column = token().column;
    const Quantities::Thing thing = thing_argument();
    if (thing.body < 0) return thing.fingers;
    throw Fault{column, fmt::format("'{}' is neither a finger nor a hand", thing_),
                "Name a finger or a hand, or leave the argument out."};
}

ShortForms::Value ShortForms::number_argument(double value, const Dimension& dimension) {
    if (!take(",")) return number(constant(value), dimension, token().column);
    Value out = choice();
    demand(out, Type::number);
    Value wanted = number(-1, dimension, out.column);
    match(out, wanted, out.column);
    return out;
}

ShortForms::Value ShortForms::inside(const Token& name) {
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

ShortForms::Value ShortForms::opposite(Value value) {
    value.node[0] = apply(kNot, {value.node[0], -1, -1});
    return value;
}

ShortForms::Value ShortForms::pressed(const Token& name, int fingers) {
    const int body = body_argument();
    const int count = slot(quantities_.pressing(body, fingers_argument()));
    note(Kind::tick);
    return truth(apply(kAtLeast, count, constant(fingers)), name.column);
}

ShortForms::Value ShortForms::lifted(const Token& name) {
    const int body = body_argument();
    const Value z = of_thing(thing_, "position.z", name.column);
    const int rise =
        apply(kSubtract, z.node[0], slot(quantities_.start(static_cast<size_t>(body)) + 2));
    const Value height = number_argument(0.02, dimension(Quantity::length));
    return truth(apply(kAtLeast, rise, height.node[0]), name.column);
}

ShortForms::Value ShortForms::still(const Token& name) {
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

ShortForms::Value ShortForms::contact_force(const Token& name) {
    const Quantities::Thing a = thing_argument();
    expect(",");
    const Quantities::Thing b = thing_argument();
    note(Kind::tick);
    return number(slot(quantities_.contact_force(a, b)), dimension(Quantity::force), name.column);
}

ShortForms::Value ShortForms::rate(const Token& name) {
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

ShortForms::Value ShortForms::look_back(const Token& name, LookBack::Statistic statistic) {
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
    out.of = expression_of(of.node[0]);
    out.slot = quantities_.define_unnamed(of.dimension).slot;
    look_backs_.push_back(out);
    note(Kind::figure);
    return number(slot(out.slot), of.dimension, name.column);
}

size_t ShortForms::trials_argument(const Token& name) {
    const size_t column = token().column;
    if (!take(","))
        throw Fault{column, "the number of trials is missing",
                    fmt::format("Write e.g. {}(x, 10).", name.text)};
    const Value count = choice();
    const double trials =
        count.type == Type::number && is_constant(count.node[0]) ? constant_of(count.node[0]) : 0;
    if (!(trials >= 1 && trials <= LookBack::kMost) || trials != std::floor(trials))
        throw Fault{column,
                    fmt::format("the number of trials must be a whole number from 1 to {}",
                                LookBack::kMost),
                    fmt::format("Write e.g. {}(x, 10).", name.text)};
    return static_cast<size_t>(trials);
}

}  // namespace dihaptic::task
