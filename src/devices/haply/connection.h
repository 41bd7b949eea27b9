// A WebSocket connection to a service, for a real-time loop: messages pass through buffers that are
// allocated once, and each call has a time limit.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "base/clock.h"

namespace dihaptic::devices::haply {

/// ws://host:port/path
struct Url {
    std::string host;
    int port = 80;
    std::string path = "/";

    /// Returns nullopt if the text is not such an address.
    static std::optional<Url> parse(const std::string& text);
};

class Connection {
  public:
    /// Longest message that can be received [bytes]. A full inventory has about 2000 a device.
    static constexpr size_t kMostBytes = 1 << 18;
    /// Number of bytes after each message that must be readable, because the parser reads past the
    /// end.
    static constexpr size_t kPadding = 64;

    Connection();
    ~Connection();
    Connection(const Connection&) = delete;
    Connection& operator=(const Connection&) = delete;

    /// Connects and shakes hands. Throws an Error with the address, the cause and the
    /// remedy.
    void open(const Url& url, Time time_out);
    void close() noexcept;
    bool is_open() const noexcept;

    /// Sends a text message; false when the connection is lost.
    bool send(std::string_view message, Time time_out) noexcept;
    /// The next message, valid until the next call. Empty if no message was complete in time or the
    /// connection is lost; the connection is then closed, since a late answer would be mistaken for
    /// the next answer.
    std::string_view receive(Time time_out) noexcept;

    /// Ends the connection from any thread, while another is in send() or receive().
    void shut_down() noexcept;

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace dihaptic::devices::haply
