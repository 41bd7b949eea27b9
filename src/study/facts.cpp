#include "study/facts.h"

#include <algorithm>
#include <numeric>

namespace dihaptic::study {

const FactSpec* spec_of(const StudyFile& study, const std::string& fact) {
    const auto found = std::ranges::find(study.facts, fact, &FactSpec::name);
    return found == study.facts.end() ? nullptr : &*found;
}

bool is_known(const StudyFile& study, const std::string& fact) {
    return spec_of(study, fact) != nullptr ||
           std::ranges::find(kStandardFacts, fact) != kStandardFacts.end();
}

std::vector<std::string> values_of(const StudyFile& study, const std::string& fact) {
    if (fact == "sex") return {"F", "M", "O", "U"};
    if (fact == "handedness") return {"right", "left", "both"};
    const FactSpec* spec = spec_of(study, fact);
    return spec == nullptr ? std::vector<std::string>{} : spec->values;
}

bool is_number(const StudyFile& study, const std::string& fact) {
    return values_of(study, fact).empty();
}

int smallest_block(const StudyFile& study) {
    int divisor = 0;
    for (const Group& group : study.groups) divisor = std::gcd(divisor, group.people);
    return divisor == 0 ? 0 : study.people() / divisor;
}

}  // namespace dihaptic::study
