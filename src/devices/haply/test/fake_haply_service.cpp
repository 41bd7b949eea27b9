// A fake Inverse Service for tests of the whole program. It is a separate process, which outlives
// its client like the real service, and ends with the process that started it.
//
//   fake_haply_service [DEVICES]      prints its address, then the devices' serial numbers, a line
//                                     each; 2 devices by default
//
// It ticks at 1 kHz on the real clock. As with the manufacturers' fake libraries,
// DIHAPTIC_FAKE_PUSH moves its handles, and DIHAPTIC_FAKE_FELT shows the forces of its devices. A
// force lasts one tick; it is not known for how long Haply's own service leaves a force on.
#include <fmt/format.h>
#include <sys/prctl.h>
#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <cstdlib>

#include "devices/haply/test/fake_service.h"
#include "devices/test/felt_outside.h"

#include "base/number.h"

int main(int argc, char** argv) {
    using namespace dihaptic::devices;
    prctl(PR_SET_PDEATHSIG, SIGTERM);
    const int count = argc > 1 ? dihaptic::whole_number<int>(argv[1]).value() : 2;
    if (count < 1 || count > static_cast<int>(FeltOutside::kDevices)) {
        fmt::print(stderr, "usage: {} [DEVICES], 1 to {}\n", argv[0], FeltOutside::kDevices);
        return 1;
    }
    haply::FakeService::Setup setup;
    setup.devices.resize(static_cast<size_t>(count));
    setup.ids.resize(setup.devices.size());
    for (size_t i = 3; i < setup.ids.size(); ++i) setup.ids[i] = fmt::format("04A{}", i);
    setup.rate = 1000;
    setup.hand = pushing_hand();
    if (!setup.hand) setup.hand = [](size_t, double, const dihaptic::Wrench&) { return Held{}; };
    const haply::FakeService service(setup, {});
    fmt::print("{}\n", service.url());
    for (const std::string& id : setup.ids) fmt::print("{}\n", id);
    std::fflush(stdout);
    for (;;) pause();
}
