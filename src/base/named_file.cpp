#include "base/named_file.h"

#include "base/regular_file.h"

namespace dihaptic {

void check_named(const std::string& file, const Place& place, const std::string& key) {
    try {
        const RegularFile opened(file);
    } catch (const Error& e) {
        const Problem& why = e.problems().front();
        throw Error(place, key, file + " " + why.what, why.remedy);
    }
}

}  // namespace dihaptic
