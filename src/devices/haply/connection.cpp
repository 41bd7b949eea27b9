#include "devices/haply/connection.h"

#include <fmt/format.h>
#include <netdb.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <boost/asio/io_context.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/websocket.hpp>
#include <charconv>
#include <vector>

#include "base/diagnostics.h"
#include "base/number.h"
#include "devices/haply/answerer.h"

namespace dihaptic::devices::haply {
namespace {

namespace net = boost::asio;
namespace beast = boost::beast;
namespace websocket = boost::beast::websocket;
using beast::error_code;
using Steady = std::chrono::steady_clock;

constexpr const char* kStart =
    "Start the Inverse Service (sudo systemctl start haply-inverse-service), or correct 'url'.";

error_code system_error(int number) {
    return {number, boost::system::system_category()};
}

/// A socket with a deadline for reading and writing. Beast's own time limits work only with its
/// asynchronous calls, which allocate memory.
class TimedSocket {
  public:
    using executor_type = net::io_context::executor_type;

    explicit TimedSocket(net::io_context& context) : context_(context) {}
    ~TimedSocket() { close(); }

    executor_type get_executor() noexcept { return context_.get_executor(); }
    int descriptor() const noexcept { return fd_.load(); }
    void set_deadline(Steady::time_point deadline) { deadline_ = deadline; }

    /// Connects to the first of the host's addresses that responds before the deadline.
    error_code connect(const addrinfo* addresses) {
        error_code ec = net::error::host_not_found;
        for (const addrinfo* address = addresses; address != nullptr; address = address->ai_next) {
            ec = connect_to(*address);
            if (!ec) return ec;
            close();
        }
        return ec;
    }
    void close() noexcept {
        const int fd = fd_.exchange(-1);
        if (fd >= 0) ::close(fd);
    }
    void shut_down() noexcept {
        if (const int fd = fd_.load(); fd >= 0) ::shutdown(fd, SHUT_RDWR);
    }

    template <class Buffers>
    size_t read_some(const Buffers& buffers, error_code& ec) {
        const net::mutable_buffer first = first_of<net::mutable_buffer>(buffers);
        return transfer(POLLIN, ec, [&] {
            const ssize_t n = ::recv(fd_.load(), first.data(), first.size(), MSG_DONTWAIT);
            if (n == 0 && first.size() > 0) ec = net::error::eof;
            return n;
        });
    }
    template <class Buffers>
    size_t write_some(const Buffers& buffers, error_code& ec) {
        // TCP_NODELAY sends data at once, so a frame's header and text have to go in one segment
        std::array<iovec, 8> parts{};
        msghdr message{};
        message.msg_iov = parts.data();
        for (auto it = net::buffer_sequence_begin(buffers);
             it != net::buffer_sequence_end(buffers) && message.msg_iovlen < parts.size(); ++it) {
            const net::const_buffer part = *it;
            // the cast is safe because sendmsg() only reads from this pointer
            parts[message.msg_iovlen++] = {const_cast<void*>(part.data()), part.size()};
        }
        return transfer(POLLOUT, ec, [&] {
            return ::sendmsg(fd_.load(), &message, MSG_DONTWAIT | MSG_NOSIGNAL);
        });
    }
    // Beast's concept of a stream requires these functions, although nothing here calls them.
    template <class Buffers>
    size_t read_some(const Buffers& buffers) {
        error_code ec;
        const size_t n = read_some(buffers, ec);
        if (ec) throw beast::system_error(ec);
        return n;
    }
    template <class Buffers>
    size_t write_some(const Buffers& buffers) {
        error_code ec;
        const size_t n = write_some(buffers, ec);
        if (ec) throw beast::system_error(ec);
        return n;
    }

    friend void teardown(beast::role_type, TimedSocket& socket, error_code& ec) {
        socket.shut_down();
        ec = {};
    }

  private:
    template <class Buffer, class Buffers>
    static Buffer first_of(const Buffers& buffers) {
        for (auto it = net::buffer_sequence_begin(buffers); it != net::buffer_sequence_end(buffers);
             ++it) {
            if (Buffer(*it).size() > 0) return *it;
        }
        return {};
    }

    /// Repeats `call` until it succeeds or fails, or until the deadline passes.
    template <class Call>
    size_t transfer(short event, error_code& ec, const Call& call) {
        ec = {};
        while (true) {
            const ssize_t n = call();
            if (ec) return 0;
            if (n >= 0) return static_cast<size_t>(n);
            if (errno == EINTR) continue;
            if (errno != EAGAIN && errno != EWOULDBLOCK) {
                ec = system_error(errno);
                return 0;
            }
            ec = wait(event);
            if (ec) return 0;
        }
    }

    error_code wait(short event) const {
        pollfd polled{fd_.load(), event, 0};
        while (true) {
            const Time left = std::max(Time(0), Time(deadline_ - Steady::now()));
            const auto whole = std::chrono::duration_cast<std::chrono::seconds>(left);
            timespec limit{};
            limit.tv_sec = whole.count();
            limit.tv_nsec = (left - whole).count();
            const int ready = ::ppoll(&polled, 1, &limit, nullptr);
            if (ready > 0) return {};
            if (ready == 0) return net::error::timed_out;
            if (errno != EINTR) return system_error(errno);
        }
    }

    error_code connect_to(const addrinfo& address) {
        fd_ = ::socket(address.ai_family, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
        if (fd_ < 0) return system_error(errno);
        const int on = 1;
        ::setsockopt(fd_, IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
        if (::connect(fd_, address.ai_addr, address.ai_addrlen) == 0) return {};
        if (errno != EINPROGRESS) return system_error(errno);
        if (const error_code ec = wait(POLLOUT)) return ec;
        int failure = 0;
        socklen_t size = sizeof failure;
        ::getsockopt(fd_, SOL_SOCKET, SO_ERROR, &failure, &size);
        return failure == 0 ? error_code{} : system_error(failure);
    }

    net::io_context& context_;
    std::atomic<int> fd_{-1};
    Steady::time_point deadline_;
};

}  // namespace

std::optional<Url> Url::parse(const std::string& text) {
    constexpr std::string_view kScheme = "ws://";
    if (text.rfind(kScheme, 0) != 0) return {};
    Url url;
    std::string address = text.substr(kScheme.size());
    if (const size_t slash = address.find('/'); slash != std::string::npos) {
        url.path = address.substr(slash);
        address.resize(slash);
    }
    if (const size_t colon = address.find(':'); colon != std::string::npos) {
        const char* begin = address.data() + colon + 1;
        const char* end = address.data() + address.size();
        const auto [rest, ec] = std::from_chars(begin, end, url.port);
        if (ec != std::errc{} || rest != end || url.port < 1 || url.port > 65535) return {};
        address.resize(colon);
    }
    if (address.empty()) return {};
    url.host = address;
    return url;
}

struct Connection::Impl {
    using Stream = websocket::stream<TimedSocket, false>;

    net::io_context context;  // Beast's timers need a context, although it is never run
    Stream stream{context};
    bool open = false;
    std::vector<char> message = std::vector<char>(kMostBytes + kPadding);

    void allow(Time time_out) { stream.next_layer().set_deadline(Steady::now() + time_out); }
    void lose() noexcept {
        open = false;
        stream.next_layer().shut_down();
    }
};

Connection::Connection() = default;
Connection::~Connection() {
    close();
}

bool Connection::is_open() const noexcept {
    return impl_ && impl_->open;
}

void Connection::open(const Url& url, Time time_out) {
    const std::string where = fmt::format("{} port {}", url.host, url.port);
    addrinfo hints{};
    hints.ai_socktype = SOCK_STREAM;
    addrinfo* found = nullptr;
    const int failure =
        ::getaddrinfo(url.host.c_str(), number_text(url.port).c_str(), &hints, &found);
    if (failure != 0) {
        throw Error(
            fmt::format("there is no computer named {} ({})", url.host, gai_strerror(failure)),
            "Correct 'url': the service's default is ws://localhost:10001/.");
    }
    const std::unique_ptr<addrinfo, void (*)(addrinfo*)> addresses(found, ::freeaddrinfo);

    // a new stream is needed because a closed one cannot be reopened
    impl_ = std::make_unique<Impl>();
    impl_->allow(time_out);
    error_code ec = impl_->stream.next_layer().connect(addresses.get());
    if (ec) throw Error(fmt::format("nothing answers at {} ({})", where, ec.message()), kStart);

    impl_->stream.handshake(fmt::format("{}:{}", url.host, url.port), url.path, ec);
    if (ec == websocket::error::upgrade_declined) {
        throw Error(fmt::format("the web server at {} refused a WebSocket handshake", where),
                    "Correct 'url': the service accepts commands at ws://localhost:10001/ by "
                    "default; another program may have its port.");
    }
    if (ec) {
        throw Error(
            fmt::format("the program that listens at {} is not a WebSocket service ({})", where,
                        ec == net::error::timed_out ? "no answer in time" : ec.message()),
            "Correct 'url': another program may have the Inverse Service's port.");
    }
    if (const auto user = user_at_other_end(impl_->stream.next_layer().descriptor());
        user && !may_serve(*user)) {
        throw Error(
            fmt::format("the program that answers at {} belongs to another user (number {})", where,
                        *user),
            "End that program, or correct 'url': the Inverse Service belongs to the system.");
    }
    impl_->stream.text(true);
    impl_->stream.auto_fragment(false);
    impl_->open = true;
}

void Connection::close() noexcept {
    if (!impl_) return;
    if (impl_->open) {
        error_code ec;
        impl_->allow(std::chrono::milliseconds(100));
        impl_->stream.close(websocket::close_code::normal, ec);
        impl_->open = false;
    }
    impl_->stream.next_layer().close();
}

bool Connection::send(std::string_view message, Time time_out) noexcept {
    if (!is_open()) return false;
    error_code ec;
    impl_->allow(time_out);
    impl_->stream.write(net::buffer(message.data(), message.size()), ec);
    if (ec) impl_->lose();
    return !ec;
}

std::string_view Connection::receive(Time time_out) noexcept {
    if (!is_open()) return {};
    impl_->allow(time_out);
    size_t size = 0;
    do {
        error_code ec;
        size += impl_->stream.read_some(
            net::buffer(impl_->message.data() + size, kMostBytes - size), ec);
        if (ec || size == kMostBytes) {
            impl_->lose();
            return {};
        }
    } while (!impl_->stream.is_message_done());
    if (size == 0) impl_->lose();
    return {impl_->message.data(), size};
}

void Connection::shut_down() noexcept {
    if (impl_) impl_->stream.next_layer().shut_down();
}

}  // namespace dihaptic::devices::haply
