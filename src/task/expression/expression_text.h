// Tokens of an expression's text: words, numbers and symbols.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace dihaptic::task {

/// A mistake in the text, with its location; thrown during compilation.
struct Fault {
    size_t column;  // counted from 1
    std::string what;
    std::string remedy;
    std::vector<std::string> known = {};  // names that are valid in place of an unknown name
};

struct Token {
    enum class Kind { number, name, quoted, symbol, end };
    Kind kind = Kind::end;
    std::string text;
    double value = 0;
    size_t column = 1;

    bool is(std::string_view symbol) const {
        return (kind == Kind::symbol || kind == Kind::name) && text == symbol;
    }
};

/// Splits the text into tokens, the last of which marks the end. Throws Fault.
std::vector<Token> tokens_of(std::string_view text);

}  // namespace dihaptic::task
