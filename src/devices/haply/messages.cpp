#include "devices/haply/messages.h"

#include <cassert>
#include <charconv>

#define SIMDJSON_EXCEPTIONS 0  // calls that could throw then do not compile
#include <simdjson.h>

#include "base/unmeasured.h"
#include "devices/haply/connection.h"

namespace dihaptic::devices::haply {
namespace {

namespace json = simdjson::ondemand;

static_assert(Connection::kPadding >= simdjson::SIMDJSON_PADDING);

/// Calls `use(key, value)` for each member of an object. Returns false if the text is truncated or
/// is not an object.
template <class Use>
bool for_members(const simdjson::simdjson_result<json::object>& object, const Use& use) {
    if (object.error()) return false;
    json::object members = object.value_unsafe();
    for (const auto& member : members) {
        if (member.error()) return false;
        json::field field = member.value_unsafe();
        std::string_view key;
        if (field.unescaped_key().get(key) || !use(key, field.value())) return false;
    }
    return true;
}

/// Calls `use(element)` for each element of an array. Returns false if the text is truncated or is
/// not an array.
template <class Use>
bool for_elements(json::value value, const Use& use) {
    json::array elements;
    if (value.get_array().get(elements)) return false;
    for (const auto& element : elements) {
        if (element.error() || !use(element.value_unsafe())) return false;
    }
    return true;
}

double number(json::value value) {
    double out = kUnmeasured;
    return value.get_double().get(out) ? kUnmeasured : out;
}

std::string_view text(json::value value) {
    std::string_view out;
    return value.get_string().get(out) ? std::string_view{} : out;
}

std::optional<bool> flag(json::value value) {
    bool out = false;
    if (value.get_bool().get(out)) return {};
    return out;
}

bool read_vector(json::value value, std::optional<Vec3>& out) {
    out = Vec3::Constant(kUnmeasured);
    bool null = false;
    if (value.is_null().get(null)) return false;
    if (null) return true;
    Vec3 v = Vec3::Zero();
    const bool whole = for_members(value.get_object(), [&](std::string_view key, json::value part) {
        if (key == "x") v.x() = number(part);
        if (key == "y") v.y() = number(part);
        if (key == "z") v.z() = number(part);
        return true;
    });
    out = v;
    return whole;
}

bool read_rotation(json::value value, std::optional<Quat>& out) {
    Quat q = Quat::Identity();
    const bool whole = for_members(value.get_object(), [&](std::string_view key, json::value part) {
        if (key == "x") q.x() = number(part);
        if (key == "y") q.y() = number(part);
        if (key == "z") q.z() = number(part);
        if (key == "w") q.w() = number(part);
        return true;
    });
    out = q;
    return whole;
}

bool read_buttons(json::value value, uint32_t& out) {
    return for_members(value.get_object(), [&](std::string_view key, json::value part) {
        if (key.size() == 1 && key[0] >= 'a' && key[0] <= 'c' && flag(part).value_or(false))
            out |= 1u << (key[0] - 'a');
        return true;
    });
}

bool read_device(json::value value, DeviceState& out) {
    return for_members(value.get_object(), [&](std::string_view key, json::value part) {
        if (key == "device_id") out.id = text(part);
        if (key == "state") {
            return for_members(part.get_object(), [&](std::string_view name, json::value field) {
                if (name == "cursor_position") return read_vector(field, out.p_DH);
                if (name == "cursor_velocity") return read_vector(field, out.v_DH);
                return true;
            });
        }
        if (key == "status") {
            return for_members(part.get_object(), [&](std::string_view name, json::value field) {
                if (name == "calibrated") out.calibrated = flag(field);
                if (name == "ready") out.ready = flag(field);
                if (name == "power_supply") out.power_supply = flag(field);
                return true;
            });
        }
        return true;
    });
}

bool read_grip(json::value value, GripState& out) {
    return for_members(value.get_object(), [&](std::string_view key, json::value part) {
        if (key == "device_id") out.id = text(part);
        if (key != "state") return true;
        return for_members(part.get_object(), [&](std::string_view name, json::value field) {
            if (name == "orientation") return read_rotation(field, out.R);
            if (name == "buttons") return read_buttons(field, out.buttons);
            return true;
        });
    });
}

template <class List, class Match>
auto only(const List& list, const Match& match) -> decltype(list.data()) {
    decltype(list.data()) found = nullptr;
    for (const auto& each : list) {
        if (!match(each)) continue;
        if (found != nullptr) return nullptr;
        found = &each;
    }
    return found;
}

}  // namespace

const DeviceState* StateMessage::device(std::string_view id) const {
    return only(devices(), [&](const DeviceState& each) { return each.id == id; });
}

const GripState* StateMessage::grip(GripKind kind, std::string_view id) const {
    return only(grips(), [&](const GripState& each) { return each.kind == kind && each.id == id; });
}

struct StateReader::Impl {
    json::parser parser;
};

StateReader::StateReader(size_t most_bytes) : impl_(std::make_unique<Impl>()) {
    [[maybe_unused]] const auto error = impl_->parser.allocate(most_bytes);
    assert(!error);
}

StateReader::~StateReader() = default;

bool StateReader::read(std::string_view text_of_message, StateMessage& out) noexcept {
    out.device_count = 0;
    out.grip_count = 0;
    out.error = {};
    json::document document;
    const simdjson::padded_string_view padded(text_of_message.data(), text_of_message.size(),
                                              text_of_message.size() + Connection::kPadding);
    if (impl_->parser.iterate(padded).get(document)) return false;

    const auto add_grip = [&](GripKind kind, json::value each) {
        GripState state;
        state.kind = kind;
        if (!read_grip(each, state)) return false;
        if (out.grip_count < out.grip_list.size()) out.grip_list[out.grip_count++] = state;
        return true;
    };
    const bool whole =
        for_members(document.get_object(), [&](std::string_view key, json::value value) {
            if (key == "error") out.error = text(value);
            if (key == "inverse3") {
                return for_elements(value, [&](json::value each) {
                    DeviceState state;
                    if (!read_device(each, state)) return false;
                    if (out.device_count < out.device_list.size())
                        out.device_list[out.device_count++] = state;
                    return true;
                });
            }
            for (const GripKind kind : {GripKind::verse_grip, GripKind::wireless_verse_grip}) {
                if (key != enum_name(kind)) continue;
                return for_elements(value, [&](json::value each) { return add_grip(kind, each); });
            }
            return true;
        });
    return whole && document.current_location().error() == simdjson::OUT_OF_BOUNDS;
}

namespace {

constexpr std::string_view kProfile =
    R"("session":{"configure":{"profile":{"name":"org.dihaptic:dihaptic"}}},)";
constexpr size_t kNumberBytes = 32;
/// Number of bytes that a device takes up in the message, not counting its serial number.
constexpr size_t kDeviceBytes = 128 + 3 * kNumberBytes;

}  // namespace

CommandWriter::CommandWriter(std::vector<Device> devices) : devices_(std::move(devices)) {
    size_t size = 64 + kProfile.size();
    for (const Device& device : devices_) size += kDeviceBytes + device.id.size();
    text_.reserve(size);
}

std::string_view CommandWriter::write(std::span<const Vec3> forces_D, bool first) noexcept {
    assert(forces_D.size() == devices_.size());
    const auto add_number = [&](double value) {
        std::array<char, kNumberBytes> digits;
        const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), value).ptr;
        text_.append(digits.data(), end);
    };
    text_.assign("{");
    if (first) text_.append(kProfile);
    text_.append(R"("inverse3":[)");
    for (size_t i = 0; i < devices_.size(); ++i) {
        if (i > 0) text_.append(",");
        text_.append(R"({"device_id":")").append(devices_[i].id);
        text_.append(R"(","commands":{"set_cursor_force":{")");
        text_.append(enum_name(devices_[i].key)).append(R"(":{"x":)");
        add_number(forces_D[i].x());
        text_.append(R"(,"y":)");
        add_number(forces_D[i].y());
        text_.append(R"(,"z":)");
        add_number(forces_D[i].z());
        text_.append("}}}}");
    }
    text_.append("]}");
    return text_;
}

}  // namespace dihaptic::devices::haply
