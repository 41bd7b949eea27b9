#include "cli/doctor/makers.h"

#include <fmt/format.h>

namespace dihaptic::doctor {

Findings of_maker(const std::string& backend, const devices::Survey& survey) {
    Findings out;
    for (const devices::Survey::Device& device : survey.devices)
        out.push_back(
            {device.state == "ready" ? Verdict::ok : Verdict::note,
             backend,
             fmt::format("{}{}: {}", device.model,
                         device.serial.empty() ? "" : ", serial " + device.serial, device.state),
             {}});
    // a laboratory usually has devices from one maker only, and does not need other makers'
    // libraries
    if (!survey.missing.empty()) out.push_back({Verdict::note, backend, survey.missing, {}});
    return out;
}

}  // namespace dihaptic::doctor
