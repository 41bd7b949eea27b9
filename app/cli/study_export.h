// Exports all complete sessions of a study.
#pragma once

#include <string>

#include "study_collection.h"

namespace dihaptic::cli {

/// Adds to the BIDS data set all sessions that it does not contain yet. Throws Error at the first
/// session that cannot be added; the sessions added before remain.
void export_bids(const StudyData& data, const std::string& data_set);

/// Writes the study's joined tables as a Psych-DS data set into `folder`, which must not exist yet.
void export_psych_ds(const StudyData& data, const std::string& folder);

}  // namespace dihaptic::cli
