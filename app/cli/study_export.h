// Exports all complete sessions of a study.
#pragma once

#include <string>

#include "study_collection.h"

namespace dihaptic::cli {

/// Adds the sessions that the BIDS data set lacks. Throws Error at the first that cannot be added;
/// those before it stay.
void export_bids(const StudyData& data, const std::string& data_set);

/// Makes a Psych-DS data set of the study's joined tables in a folder that does not exist yet.
void export_psych_ds(const StudyData& data, const std::string& folder);

}  // namespace dihaptic::cli
