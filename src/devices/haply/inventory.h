// Compares the Inverse Service's list with the devices in a rig file.
#pragma once

#include <span>

#include "devices/device_group.h"
#include "devices/haply/connection.h"
#include "devices/haply/messages.h"

namespace dihaptic::devices::haply {

/// Time limit for connecting and for the first messages, which need longer than those of the cycle.
constexpr Time kSetUpTime = std::chrono::seconds(2);

struct Grip {
    GripKind kind;
    std::string id;
};
struct Wanted {
    Options options;
    Place place;
    std::optional<Grip> grip;  ///< grip that gives the finger's orientation
};

/// Receives an inventory, or the first answer to a command; `what` is its name in messages. Throws
/// Error.
void receive_first(Connection& connection, StateReader& reader, StateMessage& message,
                   const char* what);
/// Throws Error unless each device and grip is listed once and each device can be used.
void check_inventory(const StateMessage& message, std::span<const Wanted> devices);
/// Throws Error if the service did not understand the first command.
void check_answer(const StateMessage& message, std::span<const Wanted> devices);

/// The list of the service at `url`, for `dihaptic devices`.
Survey survey_of(const std::string& url);

}  // namespace dihaptic::devices::haply
