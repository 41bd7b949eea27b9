// The operands of expressions: numbers with their units, texts, quantities and brackets. A derived
// class parses function calls.
#pragma once

#include <algorithm>
#include <string>
#include <string_view>

#include "task/expression/grammar.h"

namespace dihaptic::task {

class Terms : protected Grammar {
  protected:
    using Grammar::Grammar;
    ~Terms() = default;

    /// Parses the call of the function `name`, at its bracket.
    virtual Value call(const Token& name) = 0;
    Value quantity(const Token& name);
    void note(Kind kind) { latest_ = std::max(latest_, kind); }
    /// Returns a vector that belongs to the thing: its position ("") or another member.
    Value of_thing(const std::string& thing, const std::string& member, size_t column);

    Kind latest_ = Kind::draw;

  private:
    Value primary() final;
    static bool is_word(std::string_view text);
    /// Parses a number with an optional unit: 5 mm, 20 mm/s, 9.81 m/s^2.
    Value with_unit(const Token& first);
    /// Converts the value to the SI unit. If the unit is an integer fraction of the SI unit, the
    /// number is divided, so that 700 ms is exactly the double 0.7.
    static double in_si(double value, double unit);
    static bool is_unit(const Token& word);
    /// Whether a unit continues with another unit, i.e. one that is not also the name of a
    /// quantity.
    bool unit_goes_on() const;
    int unit_power();
    Fault unknown(const Token& name) const;
};

}  // namespace dihaptic::task
