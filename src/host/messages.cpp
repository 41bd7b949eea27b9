#include "host/messages.h"

#include <poll.h>
#include <sys/socket.h>

#include <algorithm>
#include <cerrno>

#include "base/field_writer.h"

namespace dihaptic::host {
namespace {

using nlohmann::json;

json vector(const Vec3& v) {
    return {v.x(), v.y(), v.z()};
}
Vec3 vector_of(const json& v) {
    return {v.at(0).get<double>(), v.at(1).get<double>(), v.at(2).get<double>()};
}

json place(const Place& at) {
    return {at.file, at.line};
}
Place place_of(const json& at) {
    return {at.at(0).get<std::string>(), at.at(1).get<int>()};
}

/// Returns the node as JSON, including the position of each value in its file, which messages need.
json tree(const Node& node) {
    json out{{"at", place(node.place)}};
    if (node.kind == Node::Kind::scalar) out["scalar"] = node.scalar;
    if (node.plain) out["plain"] = true;
    if (node.kind == Node::Kind::sequence) {
        out["items"] = json::array();
        for (const Node& item : node.items) out["items"].push_back(tree(item));
    }
    if (node.kind == Node::Kind::mapping) {
        out["entries"] = json::array();
        for (const Node::Entry& entry : node.entries)
            out["entries"].push_back({entry.key, tree(entry.value)});
    }
    return out;
}

Node node_of(const json& in) {
    Node node;
    node.place = place_of(in.at("at"));
    if (in.contains("scalar")) {
        node.kind = Node::Kind::scalar;
        node.scalar = in["scalar"].get<std::string>();
        node.plain = in.value("plain", false);
    } else if (in.contains("items")) {
        node.kind = Node::Kind::sequence;
        for (const json& item : in["items"]) node.items.push_back(node_of(item));
    } else if (in.contains("entries")) {
        node.kind = Node::Kind::mapping;
        for (const json& entry : in["entries"])
            node.entries.push_back({entry.at(0).get<std::string>(), node_of(entry.at(1))});
    }
    return node;
}

/// Waits until a message arrives, for at most `most`. Returns false if none arrives in that time,
/// or soon after `given_up` returns true.
bool await_message(int socket, Time most, const std::function<bool()>& given_up) {
    constexpr int64_t kLook = 20;  // time between two checks of `given_up` [ms]
    const auto end = std::chrono::steady_clock::now() + most;
    pollfd readable{socket, POLLIN, 0};
    while (true) {
        const auto left =
            std::chrono::ceil<std::chrono::milliseconds>(end - std::chrono::steady_clock::now());
        const int64_t wait = std::clamp<int64_t>(left.count(), 0, kLook);
        const int ready = poll(&readable, 1, static_cast<int>(wait));
        if (ready > 0) return true;
        // poll() is also interrupted by a handled signal, such as Ctrl-C
        if ((ready < 0 && errno != EINTR) || left.count() <= 0) return false;
        if (given_up && given_up()) return false;
    }
}

}  // namespace

json to_json(const Order& order) {
    json configs = json::array();
    for (const devices::DeviceConfig& config : order.configs) {
        const Quat& R = config.X_WD.R;
        configs.push_back({{"finger", config.finger},
                           {"position", vector(config.X_WD.p)},
                           {"rotation", {R.w(), R.x(), R.y(), R.z()}},
                           {"options", tree(config.options)},
                           {"place", place(config.place)},
                           {"scale", config.scale}});
    }
    return {{"do", "make"},
            {"backend", order.backend},
            {"devices", configs},
            {"tick", order.tick},
            {"longest_silence", order.hosting.longest_silence},
            {"priority", order.hosting.priority}};
}

Order order_of(const json& in) {
    Order out;
    in.at("backend").get_to(out.backend);
    in.at("tick").get_to(out.tick);
    in.at("longest_silence").get_to(out.hosting.longest_silence);
    in.at("priority").get_to(out.hosting.priority);
    for (const json& device : in.at("devices")) {
        devices::DeviceConfig config;
        device.at("finger").get_to(config.finger);
        const json& R = device.at("rotation");
        config.X_WD.R = Quat(R.at(0).get<double>(), R.at(1).get<double>(), R.at(2).get<double>(),
                             R.at(3).get<double>());
        config.X_WD.p = vector_of(device.at("position"));
        config.options = node_of(device.at("options"));
        config.place = place_of(device.at("place"));
        device.at("scale").get_to(config.scale);
        out.configs.push_back(config);
    }
    return out;
}

json to_json(const devices::DeviceGroup& devices) {
    json infos = json::array();
    for (const frame::DeviceInfo& info : devices.descriptions())
        infos.push_back(tree(write_fields(info)));
    return {{"devices", infos}, {"paces", devices.paces()}};
}

std::vector<frame::DeviceInfo> infos_of(const json& in) {
    std::vector<frame::DeviceInfo> out;
    Diagnostics diagnostics;
    for (const json& one : in.at("devices"))
        read_fields(out.emplace_back(), node_of(one), diagnostics);
    diagnostics.throw_if_errors();
    return out;
}

json to_json(const Error& error) {
    json problems = json::array();
    for (const Problem& problem : error.problems()) {
        problems.push_back({problem.severity == Severity::error, place(problem.place), problem.key,
                            problem.what, problem.remedy});
    }
    return {{"problems", problems}};
}

Error error_of(const json& in) {
    std::vector<Problem> problems;
    for (const json& one : in.at("problems")) {
        problems.push_back({one.at(0).get<bool>() ? Severity::error : Severity::warning,
                            place_of(one.at(1)), one.at(2).get<std::string>(),
                            one.at(3).get<std::string>(), one.at(4).get<std::string>()});
    }
    return Error(std::move(problems));
}

void send(int socket, const json& message) {
    // a manufacturer's library may report errors in any encoding
    const std::string text = message.dump(-1, ' ', false, json::error_handler_t::replace);
    ::send(socket, text.data(), text.size(), MSG_NOSIGNAL);
}

std::optional<json> receive(int socket, Time most, const std::function<bool()>& given_up) {
    if (most > Time(0) && !await_message(socket, most, given_up)) return std::nullopt;
    const ssize_t size = recv(socket, nullptr, 0, MSG_PEEK | MSG_TRUNC);
    if (size <= 0) return std::nullopt;
    std::string text(static_cast<size_t>(size), '\0');
    if (recv(socket, text.data(), text.size(), 0) != size) return std::nullopt;
    json out = json::parse(text, nullptr, false);
    if (out.is_discarded()) return std::nullopt;
    return out;
}

}  // namespace dihaptic::host
