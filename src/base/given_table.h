// A table from a user, as spreadsheets, trackers and statistics programs write it in any
// country: with commas, semicolons or tabs between its cells (perhaps declared by a line sep=;),
// points or commas before decimals, and cells in quotes. Anything ambiguous is an error with file,
// line and remedy. The program's own tables are read by read_csv().
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/diagnostics.h"

namespace dihaptic {

/// Reads a table line by line, because movements have millions of lines.
class GivenTable {
  public:
    /// `text` is the file's text, which must outlive this object; the table starts at one of its
    /// lines.
    GivenTable(std::string_view text, std::string file, size_t begin = 0);

    /// Cells of the next line that is not empty, without the blanks around them; nullopt at the
    /// end. Throws Error if a line has an unclosed quote or thousands of cells.
    std::optional<std::vector<std::string>> next();
    /// The cells that next() will return.
    std::optional<std::vector<std::string>> peek() const { return GivenTable(*this).next(); }
    /// The line that next() returned.
    Place place() const { return {file_, line_}; }
    /// Whether empty lines preceded that line.
    bool after_gap() const { return gap_; }

    /// The number in a cell; nullopt if it is not a number. Throws Error when the table has both
    /// decimal points and decimal commas: one of the two must separate thousands.
    std::optional<double> number(const std::string& cell);
    /// Warns, at the end, about numbers in which a comma may separate thousands.
    void tell_commas(Diagnostics& diagnostics) const;

    char separator() const { return separator_; }
    /// The separator in words, e.g. "semicolons", for messages.
    const char* separators() const;

  private:
    std::string_view take_line();
    std::vector<std::string> split(std::string_view line) const;

    std::string file_;
    std::string_view rest_;
    char separator_ = ',';
    int line_ = 0;
    bool gap_ = false;
    int point_ = 0;  // line of the first number with a point before decimals; 0: none so far
    int comma_ = 0;
};

}  // namespace dihaptic
