// The messages that the program and the device host exchange outside the ticks, in JSON: the
// devices to make, their properties, and errors.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <vector>

#include "host/order.h"

namespace dihaptic::host {

nlohmann::json to_json(const Order& order);
Order order_of(const nlohmann::json& json);
/// The DeviceInfo of each device, and whether the devices pace the tick.
nlohmann::json to_json(const devices::DeviceGroup& devices);
std::vector<frame::DeviceInfo> infos_of(const nlohmann::json& json);
nlohmann::json to_json(const Error& error);
Error error_of(const nlohmann::json& json);

/// Sends a message. `socket` must be of a type that keeps messages separate (SOCK_SEQPACKET).
void send(int socket, const nlohmann::json& message);
/// Receives the next message. Returns nullopt if the other side has ended, sends nothing within
/// `most` (0 waits for ever), or sends text that is not JSON. Also returns nullopt soon after
/// `given_up` returns true.
std::optional<nlohmann::json> receive(int socket, Time most = Time(0),
                                      const std::function<bool()>& given_up = {});

}  // namespace dihaptic::host
