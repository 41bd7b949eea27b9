#include "base/given_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

#include "base/number.h"
#include "base/text_file.h"

namespace dihaptic {
namespace {

constexpr size_t kMostCellsInLine = 10'000;
constexpr std::array kSeparators{std::pair{',', "commas"}, std::pair{';', "semicolons"},
                                 std::pair{'\t', "tabs"}};

std::string_view trimmed(std::string_view text) {
    const auto is_blank = [](char c) { return c == ' ' || c == '\t'; };
    while (!text.empty() && is_blank(text.front())) text.remove_prefix(1);
    while (!text.empty() && is_blank(text.back())) text.remove_suffix(1);
    return text;
}

bool is_blank(std::string_view line) {
    return std::all_of(line.begin(), line.end(), [](char c) {
        return c == ' ' || std::any_of(kSeparators.begin(), kSeparators.end(),
                                       [c](const auto& s) { return s.first == c; });
    });
}

bool is_number(std::string_view line) {
    std::string word(trimmed(line.substr(0, line.find('\r'))));
    std::replace(word.begin(), word.end(), ',', '.');
    return finite_number(word).has_value();
}

/// The separator that occurs most often outside the quotes in a line; a comma if there is none.
char most_frequent(std::string_view line) {
    std::array<int64_t, kSeparators.size()> counts{};
    bool quoted = false;
    for (const char c : line) {
        if (c == '"') quoted = !quoted;
        for (size_t i = 0; i < counts.size() && !quoted; ++i)
            counts[i] += c == kSeparators[i].first ? 1 : 0;
    }
    return kSeparators[static_cast<size_t>(std::max_element(counts.begin(), counts.end()) -
                                           counts.begin())]
        .first;
}

}  // namespace

GivenTable::GivenTable(std::string_view text, std::string file, size_t begin)
    : file_(std::move(file)),
      line_(static_cast<int>(
          std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(begin), '\n'))) {
    text.remove_prefix(begin);
    rest_ = text;
    if (text.find('\n') == std::string_view::npos && text.find('\r') != std::string_view::npos)
        throw Error({file_, 0}, "", "its lines end in CR only, as on old Macs",
                    "Save it with LF or CR LF line endings.");
    // Microsoft's spreadsheets write such a line and expect it
    const std::string_view first = trimmed(text.substr(0, text.find_first_of("\r\n")));
    if (first.starts_with("sep=") && first.size() == 5) {
        separator_ = first[4];
        take_line();
        if (std::none_of(kSeparators.begin(), kSeparators.end(),
                         [&](const auto& s) { return s.first == separator_; }))
            throw Error({file_, 1}, "sep",
                        fmt::format("cells are not separated by '{}'", separator_),
                        "Export it with commas, semicolons or tabs between the values.");
        return;
    }
    std::string_view rest = text;
    while (!rest.empty()) {
        const size_t end = std::min(rest.find('\n'), rest.size());
        const std::string_view line = rest.substr(0, end);
        separator_ = most_frequent(line);
        // a line with a single number and a decimal comma, such as a rate from Nexus, has no
        // separator
        if (line.find(separator_) != std::string_view::npos && !is_number(line)) return;
        rest.remove_prefix(std::min(end + 1, rest.size()));
        separator_ = ',';
    }
}

const char* GivenTable::separators() const {
    return std::find_if(kSeparators.begin(), kSeparators.end(),
                        [&](const auto& s) { return s.first == separator_; })
        ->second;
}

std::string_view GivenTable::take_line() {
    const size_t end = std::min(rest_.find('\n'), rest_.size());
    std::string_view line = rest_.substr(0, end);
    rest_.remove_prefix(std::min(end + 1, rest_.size()));
    if (line.ends_with('\r')) line.remove_suffix(1);
    ++line_;
    return line;
}

std::optional<std::vector<std::string>> GivenTable::next() {
    gap_ = false;
    while (!rest_.empty()) {
        const std::string_view line = take_line();
        if (!is_blank(line)) return split(line);
        gap_ = true;
    }
    return std::nullopt;
}

std::vector<std::string> GivenTable::split(std::string_view line) const {
    std::vector<std::string> cells;
    for (;;) {
        // blanks may precede a quote; a tab counts as a blank only if it does not separate cells
        while (!line.empty() && (line[0] == ' ' || (line[0] == '\t' && separator_ != '\t')))
            line.remove_prefix(1);
        std::string& cell = cells.emplace_back();
        if (line.starts_with('"')) {
            line.remove_prefix(1);
            while (!line.starts_with('"') || line.starts_with("\"\"")) {
                if (line.empty())
                    throw Error(place(), "", "has a quote (\") that is not closed in this line",
                                "Put a \" at the cell's end, or delete it.");
                if (line[0] == '"') line.remove_prefix(1);
                cell += line[0];
                line.remove_prefix(1);
            }
            line.remove_prefix(1);
        }
        const size_t end = std::min(line.find(separator_), line.size());
        cell += trimmed(line.substr(0, end));
        if (cells.size() > kMostCellsInLine)
            throw Error(place(), "",
                        fmt::format("this line has more than {} cells", kMostCellsInLine),
                        "Check that it is the right file.");
        if (end == line.size()) return cells;
        line.remove_prefix(end + 1);
    }
}

std::optional<double> GivenTable::number(const std::string& cell) {
    const bool comma = std::count(cell.begin(), cell.end(), ',') == 1;
    std::string word = cell;
    if (comma) std::replace(word.begin(), word.end(), ',', '.');
    if (comma && cell.find('.') != std::string::npos) return std::nullopt;
    const auto value = finite_number(word);
    if (!value || (!comma && cell.find('.') == std::string::npos)) return value;
    int& first = comma ? comma_ : point_;
    if (first == 0) first = line_;
    if (point_ > 0 && comma_ > 0)
        throw Error(place(), "",
                    fmt::format("'{}' has a {} before its decimals, and line {} has a {}",
                                shortened(cell), comma ? "comma" : "point", comma ? point_ : comma_,
                                comma ? "point" : "comma"),
                    "Export all numbers with a point before their decimals, and nothing between "
                    "thousands.");
    return value;
}

void GivenTable::tell_commas(Diagnostics& diagnostics) const {
    if (comma_ == 0 || separator_ != ',') return;
    diagnostics.warning({file_, comma_}, "",
                        "from here on a comma in a number is read as a decimal point",
                        "If it separates thousands, export the table without it.");
}

}  // namespace dihaptic
