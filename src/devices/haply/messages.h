// Messages to and from the Inverse Service. They are JSON texts, written and read without
// allocating memory. README.md has an example of each kind.
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/geometry.h"
#include "devices/haply/options.h"

namespace dihaptic::devices::haply {

/// The service's report on an Inverse3. Fields that the service omits are nullopt.
struct DeviceState {
    std::string_view id;
    /// Position and velocity in D [m], [m/s]. A component that is not a number is NaN; an omitted
    /// component is 0.
    std::optional<Vec3> p_DH;
    std::optional<Vec3> v_DH;
    std::optional<bool> calibrated;
    std::optional<bool> ready;
    std::optional<bool> power_supply;
};

enum class GripKind { verse_grip, wireless_verse_grip };
constexpr auto enum_names(GripKind) {
    return std::array{"verse_grip", "wireless_verse_grip"};
}

/// The service's report on a grip.
struct GripState {
    GripKind kind = GripKind::verse_grip;
    std::string_view id;
    std::optional<Quat> R;  ///< a component that is not a number is NaN
    uint32_t buttons = 0;   ///< bits of buttons a, b and c: 1, 2, 4
};

/// A message from the service. Its texts are valid until the next message is read.
struct StateMessage {
    /// Also the largest number of grips; further devices and grips are left out.
    static constexpr size_t kMostDevices = 16;

    std::span<const DeviceState> devices() const { return {device_list.data(), device_count}; }
    std::span<const GripState> grips() const { return {grip_list.data(), grip_count}; }
    /// The only device or grip with this serial number; null if there is none, or if there is more
    /// than one.
    const DeviceState* device(std::string_view id) const;
    const GripState* grip(GripKind kind, std::string_view id) const;

    std::array<DeviceState, kMostDevices> device_list;
    size_t device_count = 0;
    std::array<GripState, kMostDevices> grip_list;
    size_t grip_count = 0;
    std::string_view error;  ///< the error reported by the service; "" if there is none
};

/// Reads messages. Does not allocate or throw after construction.
class StateReader {
  public:
    explicit StateReader(size_t most_bytes);
    ~StateReader();

    /// Reads a message. Returns false if the text is not a complete JSON object, in which case
    /// `out` is meaningless. Connection::kPadding bytes must be readable after the text.
    bool read(std::string_view text, StateMessage& out) noexcept;

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

/// Writes the message for each tick. Does not allocate or throw after construction.
class CommandWriter {
  public:
    struct Device {
        std::string id;
        ForceKey key;
    };
    explicit CommandWriter(std::vector<Device> devices);

    /// Writes a message with the forces `forces_D`, which are finite, one for each device [N]. If
    /// `first`, the message also contains this program's name. The text is valid until the next
    /// call.
    std::string_view write(std::span<const Vec3> forces_D, bool first) noexcept;

  private:
    std::vector<Device> devices_;
    std::string text_;
};

}  // namespace dihaptic::devices::haply
