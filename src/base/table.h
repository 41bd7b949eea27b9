// Tables for people and their programs: CSV files, and the tables printed by commands.
#pragma once

#include <string>
#include <variant>
#include <vector>

namespace dihaptic {

struct Table {
    struct Column {
        std::string name;  ///< with its unit, e.g. "peak_grip_N"
        std::string description;
    };
    using Cell = std::variant<std::string, double>;  ///< NaN: unmeasured, an empty cell

    std::vector<Column> columns;
    std::vector<std::vector<Cell>> rows;
};

/// One cell, without a comma's worth of surprise: text is quoted where CSV (RFC 4180) needs it.
std::string to_csv(const Table::Cell& cell);
std::string to_csv(const Table& table);

/// Writes the table, replacing the file as a whole. Throws Error when it cannot.
void write_csv(const Table& table, const std::string& file);

/// Rows of cells, the header first. Throws Error when the file cannot be read.
std::vector<std::vector<std::string>> read_csv(const std::string& file);

}  // namespace dihaptic
