// Reads JSON from other programs. Values are copied and written recursively, so without a limit a
// few kilobytes of brackets would exhaust a small stack.
#pragma once

#include <nlohmann/json.hpp>
#include <string_view>

namespace dihaptic {

/// Maximum nesting depth; no message or file of this program is nested as deeply.
constexpr int kDeepestJson = 32;

/// Parses JSON. The result is a discarded value (is_discarded()) if the text is not JSON or is
/// nested too deeply.
inline nlohmann::json parse_json(std::string_view text) {
    using Value = nlohmann::json;
    bool too_deep = false;
    const auto keep = [&](int depth, Value::parse_event_t, const Value&) {
        too_deep = too_deep || depth > kDeepestJson;
        return !too_deep;
    };
    Value out = Value::parse(text.begin(), text.end(), keep, false);
    return too_deep ? Value(Value::value_t::discarded) : out;
}

}  // namespace dihaptic
