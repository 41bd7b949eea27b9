#include "devices/haply/options.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>

#include "devices/haply/connection.h"

namespace dihaptic::devices::haply {
namespace {

bool is_serial(const std::string& text) {
    return !text.empty() && text.size() <= 32 && std::all_of(text.begin(), text.end(), [](char c) {
        return std::isxdigit(static_cast<unsigned char>(c)) != 0;
    });
}

}  // namespace

Options read_options(const DeviceConfig& config, Diagnostics& diagnostics) {
    Options options;
    Node given = config.options;
    if (given.kind == Node::Kind::null) {
        given = Node::mapping();
        given.place = config.place;
    }
    read_fields(options, given, diagnostics);
    const auto expect_serial = [&](const char* key, const std::string& text) {
        if (text.empty() || is_serial(text)) return;
        diagnostics.error(given.place, key, fmt::format("'{}' is not a serial number", text),
                          "It is hexadecimal, as `dihaptic devices` lists it, e.g. 049D.");
    };
    expect_serial("device_id", options.device_id);
    expect_serial("verse_grip", options.verse_grip);
    expect_serial("wireless_verse_grip", options.wireless_verse_grip);
    if (!options.verse_grip.empty() && !options.wireless_verse_grip.empty()) {
        diagnostics.error(given.place, "verse_grip", "there is also a wireless_verse_grip",
                          "A finger's orientation comes from one grip: leave one out.");
    }
    if (!Url::parse(options.url)) {
        diagnostics.error(given.place, "url",
                          fmt::format("'{}' is not the address of a service", options.url),
                          "It has the form ws://localhost:10001/.");
    }
    return options;
}

}  // namespace dihaptic::devices::haply
