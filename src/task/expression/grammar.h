// The operators of expressions. Parses a text by operator precedence, checks the types of its
// parts, and builds their nodes; classes derived from Grammar parse the operands.
#pragma once

#include <algorithm>
#include <string>
#include <string_view>
#include <vector>

#include "task/expression/expression_parts.h"

namespace dihaptic::task {

/// Throws Fault if the text contains a mistake.
class Grammar : protected Parts {
  protected:
    Grammar(std::string_view text, Quantities& quantities)
        : quantities_(quantities), tokens_(tokens_of(text)) {}
    ~Grammar() = default;

    const Token& token() const { return tokens_[at_]; }
    const Token& next() const { return tokens_[std::min(at_ + 1, tokens_.size() - 1)]; }
    bool take(std::string_view symbol) {
        if (!token().is(symbol)) return false;
        ++at_;
        return true;
    }
    void expect(std::string_view symbol);
    static std::string shown(const Token& token);
    /// Parses an expression, starting with the operator of lowest precedence.
    Value choice();
    /// Parses an operand.
    virtual Value primary() = 0;

    Quantities& quantities_;
    std::vector<Token> tokens_;
    size_t at_ = 0;  // index of the current token

  private:
    Value either();
    Value both();
    Value logical(const Operation& operation, const Value& a, Value (Grammar::*side)());
    Value negation();
    const Operation* comparator() const;
    /// Parses a chain of comparisons: a < b <= c means a < b and b <= c.
    Value comparison();
    void check_comparison(Value& a, Value& b, bool equality, size_t column);
    /// Checks that a quoted text is one of the possible values of the other operand.
    void check_levels(const Value& quoted, const Value& other) const;
    Value sum();
    Value product();
    Value multiplied(Value a, Value b);
    Value divided(const Value& a, const Value& b);
    Value signed_value();
    Value nested(Value (Grammar::*part)());
    Value power();

    int depth_ = 0;
};

}  // namespace dihaptic::task
