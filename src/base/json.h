// Reads JSON that others wrote. To copy and to write a value recurses into it, so that a few
// kilobytes of brackets would use up a small stack.
#pragma once

#include <nlohmann/json.hpp>
#include <string_view>

namespace dihaptic {

/// Of lists within lists: more than any message or file of the program's has.
constexpr int kDeepestJson = 32;

/// Discarded (is_discarded()) if the text is not JSON, or is nested too deeply.
inline nlohmann::json parse_json(std::string_view text) {
    using Json = nlohmann::json;
    bool too_deep = false;
    const auto keep = [&](int depth, Json::parse_event_t, const Json&) {
        too_deep = too_deep || depth > kDeepestJson;
        return !too_deep;
    };
    Json out = Json::parse(text.begin(), text.end(), keep, false);
    return too_deep ? Json(Json::value_t::discarded) : out;
}

}  // namespace dihaptic
