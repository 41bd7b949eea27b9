// Reads and writes BIDS tables, which are tab-separated, have a header and no quotes, and use n/a
// for unknown values.
#pragma once

#include <string>
#include <vector>

namespace dihaptic::analysis::bids {

using Row = std::vector<std::string>;

/// Returns the text of a table whose header is the first of `rows`. Tabs and line breaks in a cell
/// become blanks, and an empty cell becomes n/a.
std::string to_tsv(const std::vector<Row>& rows);

/// A table of a data set to which other programs may have written too: it may contain unknown
/// columns, and lack some of this program's columns.
class Tsv {
  public:
    /// Reads the table; a file that does not exist gives an empty table. Throws Error when the file
    /// cannot be read, when its first column is not `key`, or when a row does not have one cell for
    /// each column.
    Tsv(const std::string& file, const std::string& key);

    /// Cell in the row with this key; "" when there is no such row or column, or when the cell is
    /// n/a.
    std::string text(const std::string& key, const std::string& column) const;
    bool has(const std::string& key) const { return find(key) < rows_.size(); }
    /// Adds the row or, if there is a row with this key, replaces its named cells. The first column
    /// is the key. New columns are n/a in other rows; unnamed columns are n/a in a new row.
    void put(const std::vector<std::string>& columns, const Row& cells);
    size_t rows() const { return rows_.size(); }
    const Row& columns() const { return columns_; }
    std::string text(size_t row, const std::string& column) const;

    /// Writes the table, replacing the whole file. Throws Error when writing fails.
    void write() const;

  private:
    size_t find(const std::string& key) const;
    size_t column(const std::string& name) const;

    std::string file_;
    Row columns_;
    std::vector<Row> rows_;
};

}  // namespace dihaptic::analysis::bids
