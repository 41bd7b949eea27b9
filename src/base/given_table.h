// A table from a user, in any of the forms that spreadsheets, trackers and statistics programs
// write in any country: with commas, semicolons or tabs between cells (possibly declared by a line
// such as sep=;), decimal points or decimal commas, and quoted cells. Anything ambiguous is an
// error with file, line and remedy. The program's own tables are read by read_csv().
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/diagnostics.h"

namespace dihaptic {

/// Reads a table line by line, because recorded movements have millions of lines.
class GivenTable {
  public:
    /// `text` is the whole text of the file, and must outlive this object. The table starts at byte
    /// `begin`, which must be the start of a line.
    GivenTable(std::string_view text, std::string file, size_t begin = 0);

    /// The cells of the next line that is not empty, without surrounding blanks; nullopt at the
    /// end. Throws Error if the line has an unclosed quote or too many cells.
    std::optional<std::vector<std::string>> next();
    /// The cells that next() will return, without moving on.
    std::optional<std::vector<std::string>> peek() const { return GivenTable(*this).next(); }
    /// The line whose cells next() returned last.
    Place place() const { return {file_, line_}; }
    /// Whether empty lines preceded the line returned last.
    bool after_gap() const { return gap_; }

    /// The number in a cell; nullopt if the cell does not contain a number. Throws Error if the
    /// table has both decimal points and decimal commas, because one of the two must then separate
    /// thousands.
    std::optional<double> number(const std::string& cell);
    /// Must be called at the end: warns about numbers in which a comma may separate thousands.
    void tell_commas(Diagnostics& diagnostics) const;

    char separator() const { return separator_; }
    /// The separator in words for use in messages, e.g. "semicolons".
    const char* separators() const;

  private:
    std::string_view take_line();
    std::vector<std::string> split(std::string_view line) const;

    std::string file_;
    std::string_view rest_;
    char separator_ = ',';
    int line_ = 0;
    bool gap_ = false;
    int point_ = 0;  // line of the first number with a decimal point; 0 if there has been none
    int comma_ = 0;
};

}  // namespace dihaptic
