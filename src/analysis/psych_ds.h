// Writes tables as a data set in Psych-DS format (psych-ds.github.io): CSV files under data/ with
// names that state their contents, and a machine-readable description of every column, in the
// vocabulary of schema.org.
#pragma once

#include <string>
#include <vector>

#include "base/text_table.h"

namespace dihaptic::analysis {

struct PsychDs {
    std::string study;  ///< label used in file names; only letters and digits
    std::string title;
    std::string description;
    std::vector<std::string> authors;
    std::string program;
    bool simulated = false;
    std::vector<TextTable> tables;  ///< tables to be written; tables without rows are left out
};

/// Creates the data set in a folder that must not exist yet. Returns the names of the data files.
/// Throws Error when the folder exists or cannot be written, or when no table has a row.
std::vector<std::string> write_psych_ds(const PsychDs& data, const std::string& folder);

}  // namespace dihaptic::analysis
