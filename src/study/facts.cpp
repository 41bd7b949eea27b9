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

bool is_number(const StudyFile& study, const std::string& fact) {
    const FactSpec* spec = spec_of(study, fact);
    return spec == nullptr ? fact == "age" : spec->values.empty();
}

int smallest_block(const StudyFile& study) {
    int divisor = 0;
    for (const Group& group : study.groups) divisor = std::gcd(divisor, group.people);
    return divisor == 0 ? 0 : study.people() / divisor;
}

}  // namespace dihaptic::study
