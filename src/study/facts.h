// The facts that a study records about its participants, and the proportions of its groups.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "study/study_file.h"

namespace dihaptic::study {

inline constexpr std::array<std::string_view, 3> kStandardFacts{"age", "sex", "handedness"};
/// Columns of participants.csv other than the facts.
inline constexpr std::array<std::string_view, 6> kParticipantColumns{
    "id", "group", "number", "added", "version", "withdrawn"};

/// Returns the fact with this name that the study itself defines; null if there is none.
const FactSpec* spec_of(const StudyFile& study, const std::string& fact);
/// Whether the study asks for this fact.
bool is_known(const StudyFile& study, const std::string& fact);
/// Returns the values that the fact may have; empty if the fact is a number.
std::vector<std::string> values_of(const StudyFile& study, const std::string& fact);
/// Whether the fact is a number rather than a text.
bool is_number(const StudyFile& study, const std::string& fact);

/// Returns the number of people in the smallest block that contains the groups in the right
/// proportions; 0 if there are no groups.
int smallest_block(const StudyFile& study);

}  // namespace dihaptic::study
