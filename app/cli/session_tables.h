// The tables of one session, for commands that join the tables of many sessions.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/text_table.h"

namespace dihaptic::cli {

/// A table from a session's folder, with the meaning of its columns; nullopt if the folder does not
/// contain the table. Throws Error when the table cannot be read.
std::optional<TextTable> table_of(const std::string& session, const char* name);

/// The tables trials.csv, lifts.csv, corrections.csv, adaptation.csv, fits.csv and thresholds.csv
/// of a session, as far as they exist. Throws Error when a table cannot be read.
std::vector<TextTable> tables_of(const std::string& session);

}  // namespace dihaptic::cli
