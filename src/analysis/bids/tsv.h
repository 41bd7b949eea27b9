// Tables of BIDS: tab-separated, a header, no quotes, n/a for what is not known.
#pragma once

#include <string>
#include <vector>

namespace dihaptic::analysis::bids {

using Row = std::vector<std::string>;

/// The header first. Tabs and ends of lines in a cell become blanks, an empty cell n/a.
std::string to_tsv(const std::vector<Row>& rows);

/// A table of a data set that others may have written, too: it may have columns that we know
/// nothing of, and lack some of ours.
class Tsv {
  public:
    /// One that is not there is empty. Throws Error when it cannot be read, when its first column
    /// is not `key`, or when a row has not one cell for each column.
    Tsv(const std::string& file, const std::string& key);

    /// Cell of the row with that key; "" when there is no such row or column, or it is n/a.
    std::string text(const std::string& key, const std::string& column) const;
    bool has(const std::string& key) const { return find(key) < rows_.size(); }
    /// Adds the row, or replaces those of its cells that are named. Columns that are new are n/a in
    /// the other rows, and columns that are not named are n/a in a new one. The key is first.
    void put(const std::vector<std::string>& columns, const Row& cells);
    size_t rows() const { return rows_.size(); }
    const Row& columns() const { return columns_; }
    std::string text(size_t row, const std::string& column) const;

    /// Replaces the file as a whole. Throws Error when it cannot.
    void write() const;

  private:
    size_t find(const std::string& key) const;
    size_t column(const std::string& name) const;

    std::string file_;
    Row columns_;
    std::vector<Row> rows_;
};

}  // namespace dihaptic::analysis::bids
