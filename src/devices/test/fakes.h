// For each real backend, puts simulated devices behind a fake of the manufacturer's software.
#pragma once

#include <algorithm>
#include <cassert>

#include "base/field_writer.h"
#include "fake_table.h"

namespace dihaptic::devices {

/// Returns the stand-in for a backend, or null if the backend is not real.
inline const StandIn* find_stand_in(const std::string& backend) {
    const auto all = stand_ins();
    const auto found = std::find_if(all.begin(), all.end(),
                                    [&](const StandIn& one) { return one.backend == backend; });
    return found == all.end() ? nullptr : &*found;
}

/// Makes fake devices whose handles move like simulated ones and, if the fake is a library, the
/// backend's group for these devices. `context.driver` must outlive the group.
inline std::unique_ptr<DeviceGroup> make_behind(const std::string& backend,
                                                const std::vector<simulated::Options>& options,
                                                std::vector<DeviceConfig> configs,
                                                const Context& context) {
    for (size_t i = 0; i < configs.size(); ++i) configs[i].options = write_fields(options[i]);
    const StandIn::Made made = find_stand_in(backend)->make(std::move(configs), context);
    assert(made.service == nullptr);
    return find_backend(backend)->make(made.configs, context);
}

}  // namespace dihaptic::devices
