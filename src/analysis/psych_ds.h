// Writes tables as a data set in the format Psych-DS (psych-ds.github.io): CSV files under data/,
// whose names state what they contain, and a description of every column for programs, in the words
// of schema.org.
#pragma once

#include <string>
#include <vector>

#include "base/text_table.h"

namespace dihaptic::analysis {

struct PsychDs {
    std::string study;  ///< label in file names, without characters other than letters and digits
    std::string title;
    std::string description;
    std::vector<std::string> authors;
    std::string program;
    bool simulated = false;
    std::vector<TextTable> tables;  ///< tables without rows are left out
};

/// Makes the data set in a folder that does not exist yet. Returns the names of its data files.
/// Throws Error when the folder exists or cannot be written, or when no table has a row.
std::vector<std::string> write_psych_ds(const PsychDs& data, const std::string& folder);

}  // namespace dihaptic::analysis
