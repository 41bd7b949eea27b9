// The tables of one session, for commands that join those of many.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/text_table.h"

namespace dihaptic::cli {

/// A table in a session's folder, with the meaning of its columns; nullopt if it lacks the file.
/// Throws Error when it cannot be read.
std::optional<TextTable> table_of(const std::string& session, const char* name);

/// trials.csv, lifts.csv, corrections.csv, adaptation.csv, fits.csv and thresholds.csv of a
/// session, as far as it has them. Throws Error when one cannot be read.
std::vector<TextTable> tables_of(const std::string& session);

}  // namespace dihaptic::cli
