// A WebSocket connection to a service, for use in a real-time loop: the message buffers are
// allocated only once, and each call has a time limit.
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

    /// Parses an address. Returns nullopt if the text is not an address of this form.
    static std::optional<Url> parse(const std::string& text);
};

class Connection {
  public:
    /// Longest message that can be received [bytes]. A full inventory takes about 2000 bytes per
    /// device.
    static constexpr size_t kMostBytes = 1 << 18;
    /// Number of bytes that must be readable after each message, because the parser reads past the
    /// end.
    static constexpr size_t kPadding = 64;

    Connection();
    ~Connection();
    Connection(const Connection&) = delete;
    Connection& operator=(const Connection&) = delete;

    /// Connects and performs the WebSocket handshake. Throws an Error with the address, the cause
    /// and the remedy.
    void open(const Url& url, Time time_out);
    void close() noexcept;
    bool is_open() const noexcept;

    /// Sends a text message. Returns false if the connection is lost.
    bool send(std::string_view message, Time time_out) noexcept;
    /// Receives the next message, which stays valid until the next call. The result is empty if no
    /// complete message arrived in time or if the connection is lost. The connection is then
    /// closed, because a late answer would be mistaken for the answer to the next message.
    std::string_view receive(Time time_out) noexcept;

    /// Ends the connection. May be called from any thread, even while another thread is in send()
    /// or receive().
    void shut_down() noexcept;

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace dihaptic::devices::haply
