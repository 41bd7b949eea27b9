// An expression of a task: compiled and checked before the session, evaluated in the tick.
//
//     grip_force > 2 and block.z - table_top > 5 mm            a condition
//     0.5 + wait if trial_num > 10 else 200 ms                 a number
//
// Every number has a dimension. One without a unit adopts the unit of what it is added to or
// compared with, in SI; names, and numbers with a unit, have theirs. Operators bind as in Python,
// with ^ for powers and a < b < c for both; % has the sign of its right side. Vectors are added,
// subtracted, and multiplied by numbers. Of texts only == and != can be asked. Functions:
//
//     abs min max sqrt exp log sin cos tan atan2 hypot floor ceil round sign clamp
//     norm(v) distance(a, b) dot(a, b)
//     inside(thing, region) outside(thing, region)    thing: a body, a finger, a hand; hand: all
//     touched(body, thing) released(body, thing) gripped(body, hand)       thing: hand if left out
//     lifted(body, height) still(thing, speed)                             20 mm, 20 mm/s
//     contact_force(thing, thing)                                          normal force [N]
//
// A name with other characters than letters, digits and _ stands in quotes: "left plate".x.
#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "base/diagnostics.h"
#include "task/expression/quantities.h"

namespace dihaptic::task {

class Expression {
  public:
    /// Without a program: its value is 0.
    Expression() = default;
    /// A mistake goes to `diagnostics`, at `place` and `key`, with the column in the text; the
    /// expression is then empty.
    static Expression compile(std::string_view text, Quantities& quantities, const Place& place,
                              std::string_view key, Diagnostics& diagnostics);

    /// The same of an expression that is to have a quantity's unit, which `what` calls; empty for
    /// an empty text. The error for any other has `example` as its remedy.
    static Expression compile_of(Quantity quantity, const char* what, std::string_view text,
                                 Quantities& quantities, const Place& place, std::string_view key,
                                 const std::string& example, Diagnostics& diagnostics);

    bool empty() const { return program_.empty(); }
    /// truth: 0 or 1. text: the text's index, see Quantities::text().
    enum class Type { number, truth, text };
    Type type() const { return type_; }
    Dimension dimension() const { return dimension_; }
    /// Whether it depends on nothing that changes within a session but with the list of trials.
    bool frozen() const { return latest_ <= Kind::region; }
    /// Whether it depends on the list of trials, and on levels of procedures, alone.
    bool foreseen() const { return latest_ <= Kind::level; }
    /// Whether it depends on what is measured in the tick.
    bool follows_tick() const { return latest_ == Kind::tick; }
    /// Whether the value in the slot stands in it.
    bool names(int slot) const;

    /// `values`: those of the Quantities that it was compiled with, or of a copy.
    double operator()(std::span<const double> values) const noexcept;

  private:
    friend class Compiler;
    friend class Parts;
    static constexpr size_t kDeepest = 32;  // values on the stack
    using Function = double (*)(const double* arguments) noexcept;
    /// Puts a value on the stack, or a function's value in the place of its arguments.
    struct Step {
        Function function = nullptr;
        int arguments = 0;
        int slot = -1;     // without a function: of the value; -1: the constant
        double value = 0;  // the constant
    };

    std::vector<Step> program_;
    Type type_ = Type::number;
    Dimension dimension_;
    Kind latest_ = Kind::draw;  // of what it depends on
};

}  // namespace dihaptic::task
