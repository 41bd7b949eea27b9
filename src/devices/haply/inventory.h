// Compares the list of devices that the Inverse Service reports with the devices in a rig file.
#pragma once

#include <span>

#include "devices/device_group.h"
#include "devices/haply/connection.h"
#include "devices/haply/messages.h"

namespace dihaptic::devices::haply {

/// Time limit for connecting and for the first messages, which take longer than those of a tick.
constexpr Time kSetUpTime = std::chrono::seconds(2);

struct Grip {
    GripKind kind;
    std::string id;
};
struct Wanted {
    Options options;
    Place place;
    std::optional<Grip> grip;  ///< the grip that measures the finger's orientation
};

/// Receives an inventory or the first answer to a command; `what` is what error messages call it.
/// Throws Error if it does not arrive or cannot be read.
void receive_first(Connection& connection, StateReader& reader, StateMessage& message,
                   const char* what);
/// Throws Error unless each device and each grip is listed exactly once and each device can be
/// used.
void check_inventory(const StateMessage& message, std::span<const Wanted> devices);
/// Throws Error if the service did not understand the first command.
void check_answer(const StateMessage& message, std::span<const Wanted> devices);

/// The devices listed by the service at `url`, for `dihaptic devices`.
Survey survey_of(const std::string& url);

}  // namespace dihaptic::devices::haply
