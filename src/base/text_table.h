// A table of texts, as read from one file and written to another.
#pragma once

#include <string>
#include <vector>

#include "base/table.h"

namespace dihaptic {

struct TextTable {
    std::string name;  ///< name of the table's file, e.g. "trials.csv"
    std::vector<Table::Column> columns;
    std::vector<std::vector<std::string>> rows;  ///< the rows after the header
};

/// Returns the table with each number in the form in which it is written to a CSV file.
TextTable text_of(const Table& table, const std::string& name);
/// Returns the table as CSV, including the header.
std::string to_csv(const TextTable& table);

}  // namespace dihaptic
