// Tables for people and their programs: CSV files, and the tables printed by commands.
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
        std::string name;  ///< name with its unit, e.g. "peak_grip_N"
        std::string description;
        std::string unit = {};  ///< e.g. "N/s"; empty for pure numbers and texts

        std::string in_words() const {
            return unit.empty() ? description : description + " [" + unit + "]";
        }
    };
    using Cell =
        std::variant<std::string, double>;  ///< NaN: not measured, written as an empty cell

    std::vector<Column> columns;
    std::vector<std::vector<Cell>> rows;
};

/// One cell as CSV: text is quoted where RFC 4180 needs it.
std::string to_csv(const Table::Cell& cell);
std::string to_csv(const Table& table);

/// For people: numbers have six digits, unmeasured values are "-", columns are aligned.
std::string to_text(const Table::Cell& cell);
std::string to_text(const Table& table);

/// Writes the table, replacing the file as a whole. Throws Error when it cannot be written.
void write_csv(const Table& table, const std::string& file);

/// Rows of cells; the first, which always exists, is the header. Throws Error when the file is
/// empty or cannot be read.
std::vector<std::vector<std::string>> read_csv(const std::string& file);

/// A CSV file whose cells are looked up by column name. A cell that is missing, because its row is
/// short or the file lacks the column, is empty.
class CsvFile {
  public:
    /// Throws Error when the file is empty or cannot be read.
    explicit CsvFile(const std::string& file);
    /// Reads a table from a user (base/given_table.h). Throws Error, with the line, when a line has
    /// fewer or more cells than the first. Before that, `check_columns` gets the table without its
    /// rows, and may throw if a column is missing.
    static CsvFile given(const std::string& file, Diagnostics& diagnostics,
                         const std::function<void(const CsvFile&)>& check_columns);

    /// The line of a row.
    Place place(size_t row) const {
        return {file_, lines_.empty() ? static_cast<int>(row) + 2 : lines_[row]};
    }
    /// The line of the header.
    Place head() const { return {file_, head_}; }
    const std::vector<std::string>& columns() const { return header_; }
    size_t rows() const { return rows_.size(); }
    /// Position of the column with that name; nullopt if there is none.
    std::optional<size_t> column(const std::string& name) const;
    bool has(const std::string& name) const { return column(name).has_value(); }
    const std::string& text(size_t row, std::optional<size_t> column) const;
    const std::string& text(size_t row, const std::string& column) const {
        return text(row, this->column(column));
    }
    /// NaN if the cell contains no number.
    double number(size_t row, std::optional<size_t> column) const;
    double number(size_t row, const std::string& column) const {
        return number(row, this->column(column));
    }
    /// Renames a column of an earlier version's table to its present name.
    void rename(const std::string& was, const std::string& now) {
        std::replace(header_.begin(), header_.end(), was, now);
    }

  private:
    CsvFile() = default;
    std::string file_;
    int head_ = 1;
    std::vector<int> lines_;  // line of each row of a table from a user
    std::vector<std::string> header_;
    std::vector<std::vector<std::string>> rows_;
};

}  // namespace dihaptic
