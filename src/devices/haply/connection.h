// A WebSocket to a service, for a loop that must not wait longer than it says: messages go through
// buffers that are made once, and each call has its own limit of time.
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

    /// None when it is no such address.
    static std::optional<Url> parse(const std::string& text);
};

class Connection {
  public:
    /// Longest message that is understood [bytes]. A full inventory has about 2000 a device.
    static constexpr size_t kMostBytes = 1 << 18;
    /// Readable bytes after each message, which the parser wants.
    static constexpr size_t kPadding = 64;

    Connection();
    ~Connection();
    Connection(const Connection&) = delete;
    Connection& operator=(const Connection&) = delete;

    /// Connects and shakes hands. Throws Error that says where, why not, and what to do.
    void open(const Url& url, Time time_out);
    void close() noexcept;
    bool is_open() const noexcept;

    /// Sends a text message; false when the connection is lost.
    bool send(std::string_view message, Time time_out) noexcept;
    /// The next message, valid until the next call; empty when none was complete in time or the
    /// connection is lost. Either way it is closed then: an answer that comes later would be taken
    /// for the next one's.
    std::string_view receive(Time time_out) noexcept;

    /// Ends the connection from any thread, while another is in send() or receive().
    void shut_down() noexcept;

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace dihaptic::devices::haply
