#include "devices/haply/backend.h"

#include "base/json_schema.h"
#include "devices/haply/group.h"
#include "devices/haply/inventory.h"

namespace dihaptic::devices::haply {
namespace {

Survey survey() {
    return survey_of(Options{}.url);
}

}  // namespace

Backend backend() {
    return {.name = "haply",
            .describe = describe_group,
            .make = make_group,
            .real = true,
            .survey = survey,
            .options = [](JsonSchema& schema) {
                schema.part_of_kind("options", "haply", "Options.haply", Options{});
            }};
}

}  // namespace dihaptic::devices::haply
