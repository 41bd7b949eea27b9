// Tables for people and for other programs: CSV files, and the tables that commands print.
#pragma once

#include <algorithm>
#include <functional>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "base/diagnostics.h"

namespace dihaptic {

struct Table {
    struct Column {
        std::string name;  ///< name including its unit, e.g. "peak_grip_N"
        std::string description;
        std::string unit = {};  ///< e.g. "N/s"; empty for pure numbers and texts

        std::string in_words() const {
            return unit.empty() ? description : description + " [" + unit + "]";
        }
    };
    using Cell =
        std::variant<std::string, double>;  ///< NaN stands for "not measured" (an empty cell)

    std::vector<Column> columns;
    std::vector<std::vector<Cell>> rows;
};

/// Returns a cell as CSV; text is quoted where RFC 4180 requires it.
std::string to_csv(const Table::Cell& cell);
std::string to_csv(const Table& table);

/// Returns a cell or table as text for people: numbers have six digits, unmeasured values are shown
/// as "-", and columns are aligned.
std::string to_text(const Table::Cell& cell);
std::string to_text(const Table& table);

/// Writes the table to a file, replacing any earlier file as a whole. Throws Error if it cannot be
/// written.
void write_csv(const Table& table, const std::string& file);

/// Reads the rows of cells; the first row, which always exists, is the header. Throws Error if the
/// file is empty or cannot be read.
std::vector<std::vector<std::string>> read_csv(const std::string& file);

/// A CSV file whose cells are looked up by column name. A missing cell, in a short row or in a
/// column that the file does not have, is read as empty.
class CsvFile {
  public:
    /// Reads the file. Throws Error if it is empty or cannot be read.
    explicit CsvFile(const std::string& file);
    /// Reads a table from a user (base/given_table.h). Throws Error, with the line, if a line has
    /// fewer or more cells than the first. Before that, `check_columns` is called with the table
    /// without its rows, and may throw if a column is missing.
    static CsvFile given(const std::string& file, Diagnostics& diagnostics,
                         const std::function<void(const CsvFile&)>& check_columns);

    /// The place of a row: the file and the line.
    Place place(size_t row) const {
        return {file_, lines_.empty() ? static_cast<int>(row) + 2 : lines_[row]};
    }
    /// The place of the header: the file and the line.
    Place head() const { return {file_, head_}; }
    const std::vector<std::string>& columns() const { return header_; }
    size_t rows() const { return rows_.size(); }
    /// Index of the column with this name; nullopt if there is none.
    std::optional<size_t> column(const std::string& name) const;
    bool has(const std::string& name) const { return column(name).has_value(); }
    const std::string& text(size_t row, std::optional<size_t> column) const;
    const std::string& text(size_t row, const std::string& column) const {
        return text(row, this->column(column));
    }
    /// The number in a cell; NaN if the cell does not contain a number.
    double number(size_t row, std::optional<size_t> column) const;
    double number(size_t row, const std::string& column) const {
        return number(row, this->column(column));
    }
    /// Renames a column in a table from an earlier version to its present name.
    void rename(const std::string& was, const std::string& now) {
        std::replace(header_.begin(), header_.end(), was, now);
    }

  private:
    CsvFile() = default;
    std::string file_;
    int head_ = 1;
    std::vector<int> lines_;  // line number of each row, for a table from a user
    std::vector<std::string> header_;
    std::vector<std::vector<std::string>> rows_;
};

}  // namespace dihaptic
