// An expression in a task: compiled and checked before the session, evaluated in each tick.
//
//     grip_force > 2 and block.z - table_top > 5 mm            a condition
//     0.5 + wait if trial_num > 10 else 200 ms                 a number
//
// Every number has a dimension. A number without a unit takes the SI unit of the quantity that it
// is added to or compared with; names, and numbers with a unit, have their own dimensions.
// Operators have the same precedence as in Python, with ^ for powers, and a < b < c tests both
// comparisons; the result of % has the sign of its right operand. Vectors can be added, subtracted,
// and multiplied by numbers. Texts can only be compared with == and !=. Functions:
//
//     abs min max sqrt exp log sin cos tan atan2 hypot floor ceil round sign clamp
//     norm(v) distance(a, b) dot(a, b)
//     inside(thing, region) outside(thing, region)    thing: a body, a finger, a hand; hand: all
//     touched(body, thing) released(body, thing) gripped(body, hand)       thing: hand if omitted
//     lifted(body, height) still(thing, speed)                             20 mm, 20 mm/s
//     contact_force(thing, thing)                                          normal force [N]
//     rate(quantity)                                                       over 10 ticks [1/s]
//
// A name that contains characters other than letters, digits and _ is quoted: "left plate".x.
#pragma once

#include <memory>
#include <span>
#include <string_view>
#include <vector>

#include "base/diagnostics.h"
#include "task/expression/quantities.h"

namespace dihaptic::task {

struct LookBack;

class Expression {
  public:
    /// Constructs an empty expression, whose value is 0.
    Expression() = default;
    /// Compiles an expression. Mistakes are added to `diagnostics`, at `place` and `key`, with the
    /// column in the text, and the returned expression is then empty.
    static Expression compile(std::string_view text, Quantities& quantities, const Place& place,
                              std::string_view key, Diagnostics& diagnostics);

    /// Compiles an expression whose unit must be that of `quantity`, which `what` describes. An
    /// empty text gives an empty expression. The error message for any other unit suggests
    /// `example` as the remedy.
    static Expression compile_of(Quantity quantity, const char* what, std::string_view text,
                                 Quantities& quantities, const Place& place, std::string_view key,
                                 const std::string& example, Diagnostics& diagnostics);

    bool empty() const { return program_.empty(); }
    /// Type of the value. The value of a truth is 0 or 1; that of a text is its index (see
    /// Quantities::text()).
    enum class Type { number, truth, text };
    Type type() const { return type_; }
    Dimension dimension() const { return dimension_; }
    /// Whether the value depends only on the trial list.
    bool frozen() const { return latest_ <= Kind::region; }
    /// Whether the value depends only on the trial list and on levels that procedures choose.
    bool foreseen() const { return latest_ <= Kind::level; }
    /// Whether the value depends on quantities measured in each tick.
    bool follows_tick() const { return latest_ == Kind::tick; }
    /// Whether the expression uses the value in the given slot.
    bool names(int slot) const;

    /// Evaluates the expression. `values` are those of the Quantities with which the expression was
    /// compiled, or a copy of them.
    double operator()(std::span<const double> values) const noexcept;

    /// The statistics over earlier trials that the expression uses, ordered so that each follows
    /// those it depends on. The caller must set their slots before evaluating the expression.
    const std::vector<LookBack>& look_backs() const;

  private:
    friend class Compiler;
    friend class Parts;
    static constexpr size_t kDeepest = 32;  // maximum number of values on the stack
    using Function = double (*)(const double* arguments) noexcept;
    /// A step of the program: pushes a value onto the stack, or replaces the arguments of a
    /// function with its value.
    struct Step {
        Function function = nullptr;
        int arguments = 0;
        // if there is no function: slot of the value, or -1 for the constant `value`
        int slot = -1;
        double value = 0;  // the constant
    };

    std::vector<Step> program_;
    Type type_ = Type::number;
    Dimension dimension_;
    Kind latest_ = Kind::draw;                                 // latest kind of the quantities used
    std::shared_ptr<const std::vector<LookBack>> look_backs_;  // null if there are none
};

/// A statistic of an expression's values at the end of each of the last trials: mean(x, 10),
/// median(x, 10), sd(x, 10), best(x). Unmeasured values, and attempts that will be repeated, are
/// left out.
struct LookBack {
    enum class Statistic { mean, median, sd, best };
    static constexpr size_t kMost = 1000;

    Expression of;
    Statistic statistic = Statistic::mean;
    size_t count = 0;  ///< number of trials; 0 for all trials, as in best(x)
    int slot = -1;     ///< slot that holds the statistic's value
};

}  // namespace dihaptic::task
