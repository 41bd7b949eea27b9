// The words, numbers and signs of an expression's text.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace dihaptic::task {

/// A fault in the text, with its location; thrown during compilation.
struct Fault {
    size_t column;  // from 1
    std::string what;
    std::string remedy;
    std::vector<std::string> known = {};  // the valid names
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

/// The text's tokens, with an end token. Throws Fault.
std::vector<Token> tokens_of(std::string_view text);

}  // namespace dihaptic::task
