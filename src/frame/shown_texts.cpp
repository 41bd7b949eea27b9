#include "frame/shown_texts.h"

#include <fmt/format.h>

#include <cctype>
#include <cmath>

#include "base/number.h"

namespace dihaptic::frame {
namespace {

/// Parses a number format ":.Nf" (without the closing brace), which may be empty. Returns false if
/// the format is invalid.
bool read_format(std::string_view format, int& decimals) {
    if (format.empty()) return true;
    const bool fits = format.size() == 4 && format.starts_with(":.") && format[3] == 'f' &&
                      format[2] >= '0' && format[2] <= '6';
    if (fits) decimals = format[2] - '0';
    return fits;
}

/// Parses the placeholder that starts with the brace at index `begin`.
Placeholder placeholder(std::string_view text, size_t begin) {
    Placeholder out;
    out.begin = begin;
    const size_t closing = text.find('}', begin);
    out.end = closing == std::string_view::npos ? text.size() : closing + 1;
    if (text[begin] != '{' || closing == std::string_view::npos) return out;
    const std::string_view inside = text.substr(begin + 1, closing - begin - 1);
    size_t length = 0;
    const auto is_of_name = [](char c) {
        return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_' || c == '.';
    };
    while (length < inside.size() && is_of_name(inside[length])) ++length;
    const bool named = length > 0 && std::isdigit(static_cast<unsigned char>(inside[0])) == 0;
    if (named && read_format(inside.substr(length), out.decimals))
        out.name = inside.substr(0, length);
    return out;
}

std::string number(double value, int decimals) {
    if (std::isnan(value)) return "-";
    if (decimals >= 0) return fmt::format("{:.{}f}", value, decimals);
    const bool whole = value == std::floor(value) && std::abs(value) < 1e15;
    return whole ? fmt::format("{:.0f}", value) : fmt::format("{:.4g}", value);
}

bool doubled(std::string_view text, size_t i) {
    return i + 1 < text.size() && text[i + 1] == text[i];
}

}  // namespace

std::vector<Placeholder> placeholders(std::string_view text) {
    std::vector<Placeholder> out;
    size_t i = text.find_first_of("{}");
    while (i != std::string_view::npos) {
        if (doubled(text, i)) {
            i += 2;
        } else {
            out.push_back(placeholder(text, i));
            i = out.back().end;
        }
        i = text.find_first_of("{}", i);
    }
    return out;
}

std::string filled(std::string_view text, std::span<const NumberFrame>& numbers) {
    std::string out;
    const auto add_plain = [&](std::string_view part) {
        for (size_t i = 0; i < part.size(); ++i) {
            out += part[i];
            if ((part[i] == '{' || part[i] == '}') && doubled(part, i)) ++i;
        }
    };
    size_t at = 0;
    for (const Placeholder& place : placeholders(text)) {
        add_plain(text.substr(at, place.begin - at));
        at = place.end;
        if (place.name.empty() || numbers.empty()) {
            out += text.substr(place.begin, place.end - place.begin);
            continue;
        }
        out += number(numbers.front().value, place.decimals);
        numbers = numbers.subspan(1);
    }
    add_plain(text.substr(at));
    return out;
}

std::vector<std::string> shown_texts(const TaskFrame& task,
                                     const std::vector<std::string>& messages) {
    std::vector<std::string> out;
    std::span<const NumberFrame> numbers = task.numbers;
    const auto add_text = [&](int32_t message) {
        const auto i = static_cast<size_t>(message);
        out.push_back(i < messages.size() ? filled(messages[i], numbers) : number_text(message));
    };
    if (task.message >= 0) add_text(task.message);
    for (const LineFrame& line : task.lines) add_text(line.message);
    return out;
}

}  // namespace dihaptic::frame
