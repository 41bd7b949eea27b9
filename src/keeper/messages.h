// What the program and the keeper say to each other outside of the cycle, as JSON: which devices,
// what they are, and what went wrong.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <vector>

#include "keeper/order.h"

namespace dihaptic::keeper {

nlohmann::json to_json(const Order& order);
Order order_of(const nlohmann::json& json);
/// What the devices are, and whether they pace.
nlohmann::json to_json(const devices::DeviceGroup& devices);
std::vector<devices::DeviceInfo> infos_of(const nlohmann::json& json);
nlohmann::json to_json(const Error& error);
Error error_of(const nlohmann::json& json);

/// A socket that keeps messages apart (SOCK_SEQPACKET).
void send(int socket, const nlohmann::json& message);
/// The next message; nothing when the other side is gone or said nothing for `most` (0: waits for
/// ever).
std::optional<nlohmann::json> receive(int socket, Time most = Time(0));

}  // namespace dihaptic::keeper
