// Sends numbered commands, to test that each command arrives exactly once and in order.
#pragma once

#include <gtest/gtest.h>

#include "devices/haply/test/fake_service.h"

namespace dihaptic::devices::haply {

struct NumberedRun {
    size_t sent = 0;                 ///< number of messages that the service has received so far
    std::vector<double> round_trip;  ///< time from a command to the tick of its answer [s]
    double duration = 0;             ///< [s]
};

/// Paces `ticks` ticks of two devices, after `sent` messages have been sent. The force in each tick
/// is the number of the tick.
inline NumberedRun expect_no_command_lost_or_doubled(DeviceGroup& devices,
                                                     const FakeService& service, size_t sent,
                                                     int ticks) {
    using Clock = std::chrono::steady_clock;
    NumberedRun out;
    out.round_trip.reserve(static_cast<size_t>(ticks));
    std::vector<Reading> readings(2);
    std::vector<Wrench> forces(2);
    const auto number = [](int i) { return i * 1e-6; };
    uint32_t status = 0;
    int tick = 0;
    const auto begin = Clock::now();
    Clock::time_point written;
    devices.pace([&] {
        const auto now = Clock::now();
        if (tick > 0)
            out.round_trip.push_back(std::chrono::duration<double>(now - written).count());
        devices.read(now - begin, readings);
        status |= readings[0].status | readings[1].status;
        ++tick;
        forces[0].force = Vec3(number(tick), 0, 0);
        forces[1].force = Vec3(0, -number(tick), 1);
        written = Clock::now();
        devices.write(forces);
        return tick < ticks;
    });
    devices.read(Clock::now() - begin, readings);  // takes the answer to the last command
    out.duration = std::chrono::duration<double>(Clock::now() - begin).count();
    EXPECT_EQ(status | readings[0].status | readings[1].status, 0u);

    const auto received = service.received();
    out.sent = sent + 1;  // one message with zero force was sent to obtain the first state
    EXPECT_EQ(received.size(), out.sent + static_cast<size_t>(ticks));
    for (int i = 1; i <= ticks && out.sent < received.size(); ++i, ++out.sent) {
        EXPECT_EQ(received[out.sent][0], Vec3(number(i), 0, 0)) << i;
        EXPECT_EQ(received[out.sent][1], Vec3(0, -number(i), 1)) << i;
    }
    return out;
}

}  // namespace dihaptic::devices::haply
