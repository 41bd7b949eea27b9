// The tables of one session, for commands that join those of many.
#pragma once

#include <string>
#include <vector>

#include "base/text_table.h"

namespace dihaptic::cli {

/// trials.csv, lifts.csv, corrections.csv, adaptation.csv, fits.csv and thresholds.csv of a
/// session; those that it has. Throws Error when one cannot be read.
std::vector<TextTable> tables_of(const std::string& session);

}  // namespace dihaptic::cli
