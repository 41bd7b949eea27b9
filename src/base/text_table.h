// A table of texts, as read from a file and written to another one.
#pragma once

#include <string>
#include <vector>

#include "base/table.h"

namespace dihaptic {

struct TextTable {
    std::string name;  ///< name of its file, e.g. "trials.csv"
    std::vector<Table::Column> columns;
    std::vector<std::vector<std::string>> rows;  ///< without the header
};

/// The same table with each number as it is written to a CSV file.
TextTable text_of(const Table& table, const std::string& name);
/// The table as CSV, with its header.
std::string to_csv(const TextTable& table);

}  // namespace dihaptic
