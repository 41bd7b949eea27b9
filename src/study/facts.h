// The facts of a study's participants, and the proportions of its groups.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "study/study_file.h"

namespace dihaptic::study {

inline constexpr std::array<std::string_view, 3> kStandardFacts{"age", "sex", "handedness"};
/// Columns of participants.csv besides the facts.
inline constexpr std::array<std::string_view, 6> kParticipantColumns{
    "id", "group", "number", "added", "version", "withdrawn"};

/// The study's own fact with this name; null if there is none.
const FactSpec* spec_of(const StudyFile& study, const std::string& fact);
/// Whether the study asks for the fact.
bool is_known(const StudyFile& study, const std::string& fact);
/// The values that the fact may have; empty for a number.
std::vector<std::string> values_of(const StudyFile& study, const std::string& fact);
/// Whether the fact is a number.
bool is_number(const StudyFile& study, const std::string& fact);

/// Number of people in the smallest block that holds the groups in proportion; 0 without groups.
int smallest_block(const StudyFile& study);

}  // namespace dihaptic::study
