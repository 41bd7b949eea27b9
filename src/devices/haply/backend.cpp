#include "devices/haply/backend.h"

#include "devices/haply/group.h"
#include "devices/haply/inventory.h"
#include "devices/haply/options.h"

namespace dihaptic::devices::haply {
namespace {

void check(const DeviceConfig& config, Diagnostics& diagnostics) {
    read_options(config, diagnostics);
}

Survey survey() {
    return survey_of(Options{}.url);
}

}  // namespace

Backend backend() {
    return {.name = "haply", .check = check, .make = make_group, .real = true, .survey = survey};
}

}  // namespace dihaptic::devices::haply
