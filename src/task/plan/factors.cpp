#include "task/plan/factors.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "base/number.h"
#include "task/plan/lookup.h"

namespace dihaptic::task {
namespace {

constexpr size_t kMostConditions = 1000;

bool check_levels(const Factor& factor, Diagnostics& diagnostics) {
    const std::set<std::string> different(factor.levels.begin(), factor.levels.end());
    const NameInUnit unit = split_unit(factor.factor);
    if (!factor.levels.empty() && unit.quantity != Quantity::none && are_texts(factor.levels)) {
        diagnostics.error(
            factor.place, "levels",
            fmt::format("are not all numbers, and {} names their unit", factor.factor),
            fmt::format("Write numbers, or call the factor {}.", unit.name));
        return false;
    }
    if (!factor.levels.empty() && different.size() == factor.levels.size()) return true;
    diagnostics.error(factor.place, "levels",
                      factor.levels.empty() ? "there are none" : "has the same level twice",
                      fmt::format("List each level of {} once.", factor.factor));
    return false;
}

/// One condition for each choice of a level of each factor; the last factor changes fastest.
std::vector<Condition> crossed(const Task& task) {
    std::vector<Condition> out(1);
    for (const Factor& factor : task.cross) {
        std::vector<Condition> more;
        for (const Condition& condition : out) {
            for (const std::string& level : factor.levels) {
                Condition& next = more.emplace_back(condition);
                next.name += (next.name.empty() ? "" : " ") + level;
                next.factors.kind = Node::Kind::mapping;
                Node value = finite_number(level) ? Node::plain_word(level) : Node::of(level);
                value.place = factor.place;
                next.factors.set(factor.factor, value);
                next.place = factor.place;
            }
        }
        out = std::move(more);
    }
    return out;
}

void check_named(const Task& task, Diagnostics& diagnostics) {
    for (const Condition& condition : task.conditions) {
        const Node& levels = condition.factors;
        if (levels.kind == Node::Kind::mapping || levels.kind == Node::Kind::null) continue;
        diagnostics.error(levels.place, "factors", "must have a key for each factor",
                          "Write e.g. factors: { mass_g: 100 }.");
    }
}

bool check_cross(const Task& task, Diagnostics& diagnostics) {
    size_t conditions = 1;
    bool good = true;
    for (const Factor& factor : task.cross) {
        good = check_levels(factor, diagnostics) && good;
        const auto same = [&](const Factor& f) { return f.factor == factor.factor; };
        if (std::count_if(task.cross.begin(), task.cross.end(), same) > 1) {
            diagnostics.error(factor.place, "factor",
                              fmt::format("there are two factors '{}'", factor.factor),
                              "Give each a name of its own.");
            good = false;
        }
        conditions *= std::max<size_t>(1, std::min(factor.levels.size(), kMostConditions));
        if (conditions <= kMostConditions) continue;
        diagnostics.error(factor.place, "cross",
                          fmt::format("makes more than {} conditions", kMostConditions),
                          "Use fewer levels, or draw one of the factors: draws.");
        return false;
    }
    return good;
}

}  // namespace

void cross_factors(Task& task, Diagnostics& diagnostics) {
    check_named(task, diagnostics);
    if (task.cross.empty() || !check_cross(task, diagnostics)) return;
    check_names(task.conditions, "conditions", diagnostics);
    std::vector<Condition> made = crossed(task);
    for (const Condition& given : task.conditions) {
        const int i = look_up(names_of(made), given.name, given.place, "name",
                              "none of the conditions that cross makes", diagnostics);
        if (i < 0) continue;
        Condition& condition = made[static_cast<size_t>(i)];
        const Node levels = condition.factors;
        condition = given;
        condition.factors = levels;
    }
    task.conditions = std::move(made);
}

std::vector<Factor> factors_of(const Task& task) {
    std::vector<Factor> out;
    for (const Condition& condition : task.conditions) {
        for (const auto& [name, level] : condition.factors.entries) {
            const auto same = [&, &name = name](const Factor& f) { return f.factor == name; };
            auto factor = std::find_if(out.begin(), out.end(), same);
            if (factor == out.end()) {
                out.push_back({name, {}, level.place});
                factor = out.end() - 1;
            }
            if (std::find(factor->levels.begin(), factor->levels.end(), level.scalar) ==
                factor->levels.end())
                factor->levels.push_back(level.scalar);
        }
    }
    return out;
}

std::string level_of(const Condition& condition, const std::string& factor) {
    const Node* level = condition.factors.find(factor);
    return level == nullptr ? "" : level->scalar;
}

}  // namespace dihaptic::task
