// The tables of one session, for commands that join those of many.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "base/table.h"

namespace dihaptic::cli {

/// Rows of cells; the first is the header.
using Rows = std::vector<std::vector<std::string>>;

/// A table as text. Empty without rows.
Rows text_of(const Table& table);

/// trials.csv, lifts.csv, adaptation.csv, fits.csv and thresholds.csv of a session, by name; those
/// that it has. Throws Error when one cannot be read.
std::vector<std::pair<std::string, Rows>> tables_of(const std::string& session);

/// Writes rows as a file. Throws Error when this fails.
void write_rows(const Rows& rows, const std::string& file);

}  // namespace dihaptic::cli
