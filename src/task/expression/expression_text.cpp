#include "task/expression/expression_text.h"

#include <fmt/format.h>

#include <array>
#include <cctype>
#include <charconv>

namespace dihaptic::task {
namespace {

bool begins_name(char c) {
    return std::isalpha(static_cast<unsigned char>(c)) != 0 || c == '_' || (c & 0x80) != 0;
}

/// Splits the text into words, numbers and symbols.
class Lexer {
  public:
    explicit Lexer(std::string_view text) : text_(text) {}

    std::vector<Token> tokens() {
        std::vector<Token> out;
        do {
            while (at_ < text_.size() && std::isspace(static_cast<unsigned char>(text_[at_])) != 0)
                ++at_;
            Token token;
            token.column = at_ + 1;
            read(token);
            out.push_back(token);
        } while (out.back().kind != Token::Kind::end);
        return out;
    }

  private:
    void read(Token& token) {
        if (at_ == text_.size()) return;
        const char c = text_[at_];
        const bool digit_follows = at_ + 1 < text_.size() && is_digit(text_[at_ + 1]);
        if (is_digit(c) || (c == '.' && digit_follows)) {
            read_number(token);
        } else if (begins_name(c)) {
            token.kind = Token::Kind::name;
            read_name(token);
        } else if (c == '"' || c == '\'') {
            read_quoted(token);
        } else {
            read_symbol(token);
        }
    }

    static bool is_digit(char c) { return std::isdigit(static_cast<unsigned char>(c)) != 0; }

    void read_number(Token& token) {
        token.kind = Token::Kind::number;
        const char* end = text_.data() + text_.size();
        const auto result = std::from_chars(text_.data() + at_, end, token.value);
        if (result.ec != std::errc())
            throw Fault{token.column, "the number is too large or too small", "Correct it."};
        at_ = static_cast<size_t>(result.ptr - text_.data());
    }

    /// Reads a word: letters and digits, with dots between the parts.
    void read_name(Token& token) {
        const auto goes_on = [&] {
            if (at_ >= text_.size()) return false;
            if (begins_name(text_[at_]) || is_digit(text_[at_])) return true;
            return text_[at_] == '.' && at_ + 1 < text_.size() && begins_name(text_[at_ + 1]);
        };
        while (goes_on()) token.text += text_[at_++];
    }

    /// Reads a quoted text, or the quoted name of a thing followed by one of its members.
    void read_quoted(Token& token) {
        token.kind = Token::Kind::quoted;
        const char quote = text_[at_++];
        while (at_ < text_.size() && text_[at_] != quote) {
            if (text_[at_] == '\\' && at_ + 1 < text_.size()) ++at_;
            token.text += text_[at_++];
        }
        if (at_++ >= text_.size())
            throw Fault{token.column, "a quoted text has no closing quote", "Close the quotes."};
        if (at_ < text_.size() && text_[at_] == '.') {
            token.kind = Token::Kind::name;
            token.text += text_[at_++];
            read_name(token);
        }
    }

    void read_symbol(Token& token) {
        constexpr std::array kSymbols{"<=", ">=", "==", "!=", "<", ">", "+", "-",
                                      "*",  "/",  "%",  "^",  "(", ")", ","};
        constexpr std::array<std::array<const char*, 2>, 5> kOthers{
            {{"&&", "and"}, {"||", "or"}, {"!", "not"}, {"=", "=="}, {"?", "a if c else b"}}};
        const std::string_view rest = text_.substr(at_);
        for (const auto& [wrong, right] : kOthers) {
            if (!rest.starts_with(wrong) || rest.starts_with("==") || rest.starts_with("!="))
                continue;
            throw Fault{token.column, fmt::format("'{}' is not known", wrong),
                        fmt::format("Write {}.", right)};
        }
        for (const std::string_view symbol : kSymbols) {
            if (!rest.starts_with(symbol)) continue;
            token.kind = Token::Kind::symbol;
            token.text = symbol;
            at_ += symbol.size();
            if (rest.starts_with("**")) throw Fault{token.column, "'**' is not known", "Write ^."};
            return;
        }
        throw Fault{token.column, fmt::format("'{}' has no meaning here", rest.front()),
                    "Leave it out; put names with such characters in quotes."};
    }

    std::string_view text_;
    size_t at_ = 0;
};

}  // namespace

std::vector<Token> tokens_of(std::string_view text) {
    return Lexer(text).tokens();
}

}  // namespace dihaptic::task
