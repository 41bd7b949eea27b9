// The functions of expressions that take names as arguments, such as inside(thing, region), and
// those that look back over trials.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "task/expression/terms.h"

namespace dihaptic::task {

class ShortForms : protected Terms {
  protected:
    using Terms::Terms;
    ~ShortForms() = default;

    /// Parses the arguments of the short form `name` and the bracket after them. Returns nothing if
    /// there is no such form.
    std::optional<Value> short_form(const Token& name);
    /// Appends the names of all short forms.
    static void append_names(std::vector<std::string>& names);

    std::vector<LookBack> look_backs_;

  private:
    struct ShortForm {
        std::string_view name;
        Value (ShortForms::*read)(const Token&);
    };
    static constexpr size_t kShortFormCount = 13;
    static const std::array<ShortForm, kShortFormCount> kShortForms;

    bool ends_arguments() const { return token().is(")"); }
    std::string name_argument(const char* wanted);
    [[noreturn]] static void throw_unknown(size_t column, const std::string& name,
                                           const char* wanted,
                                           const std::vector<std::string>& known);
    Quantities::Thing thing_argument();
    int body_argument();
    scene::FingerSet fingers_argument();
    /// Parses a number that follows a comma; returns `value` if there is no comma.
    Value number_argument(double value, const Dimension& dimension);
    /// Parses inside(thing, region); for index.shown, the displayed position is tested.
    Value inside(const Token& name);
    Value outside(const Token& name) { return opposite(inside(name)); }
    Value touched(const Token& name) { return pressed(name, 1); }
    Value released(const Token& name) { return opposite(pressed(name, 1)); }
    Value gripped(const Token& name) { return pressed(name, 2); }
    Value opposite(Value value);
    /// Parses a condition that at least `fingers` fingers press a body.
    Value pressed(const Token& name, int fingers);
    Value lifted(const Token& name);
    Value still(const Token& name);
    Value contact_force(const Token& name);
    Value rate(const Token& name);
    Value mean(const Token& name) { return look_back(name, LookBack::Statistic::mean); }
    Value median(const Token& name) { return look_back(name, LookBack::Statistic::median); }
    Value sd(const Token& name) { return look_back(name, LookBack::Statistic::sd); }
    Value best(const Token& name) { return look_back(name, LookBack::Statistic::best); }
    Value look_back(const Token& name, LookBack::Statistic statistic);
    /// Parses the number of trials, which follows a comma.
    size_t trials_argument(const Token& name);

    std::string thing_;  // name read by the last call of thing_argument()
};

}  // namespace dihaptic::task
