#include "outlets/serial/kind.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <termios.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <optional>
#include <utility>

#include "base/descriptor.h"
#include "base/json_schema.h"

namespace dihaptic::outlets::serial {
namespace {

constexpr std::array<std::pair<int, speed_t>, 8> kSpeeds{{{9600, B9600},
                                                          {19200, B19200},
                                                          {38400, B38400},
                                                          {57600, B57600},
                                                          {115200, B115200},
                                                          {230400, B230400},
                                                          {460800, B460800},
                                                          {921600, B921600}}};

speed_t speed_of(int baud) {
    for (const auto& [known, speed] : kSpeeds) {
        if (known == baud) return speed;
    }
    return B0;
}

struct Options {
    std::string port;  ///< e.g. /dev/ttyUSB0
    int baud = 115200;
    double hold = 0;  ///< time after which code 0 is sent; 0: never [s]

    template <class Visitor>
    void visit(Visitor& v) {
        v("port", port,
          Field::text().required().says("Device file of the line, e.g. /dev/ttyUSB0."));
        v("baud", baud,
          Field::number().within(50, 4e6).says("Speed of the line, one of the standard ones."));
        v("hold", hold,
          Field::of(Quantity::time)
              .within(0, 1)
              .says("Time after which code 0 follows a code; 0: never."));
    }
};

Options read_options(const OutletConfig& config, Diagnostics& diagnostics) {
    Options options;
    if (config.options.kind == Node::Kind::null) {
        diagnostics.error(config.place, "options", "the port is missing",
                          "Add options: { port: /dev/ttyUSB0 }.");
        return options;
    }
    read_fields(options, config.options, diagnostics);
    if (speed_of(options.baud) == B0) {
        diagnostics.error(config.place, "baud",
                          fmt::format("{} is not a standard speed of serial lines", options.baud),
                          "Use 9600, 19200, 38400, 57600, 115200, 230400, 460800 or 921600.");
    }
    return options;
}

class Serial final : public Outlet {
  public:
    Serial(const Options& options, const Place& place) : options_(options) {
        // opening neither waits for the other side nor makes the line this process's terminal
        file_ = Descriptor(open(options.port.c_str(), O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC));
        if (!file_) {
            const int why = errno;
            throw Error(place, "port",
                        fmt::format("'{}' cannot be opened: {}", options.port, strerror(why)),
                        why == EACCES ? "Join the group dialout (sudo usermod -aG dialout $USER) "
                                        "and log in again."
                                      : "Plug the line in; ls /dev/tty* /dev/serial/by-id lists "
                                        "the existing ones.");
        }
        termios raw{};
        if (tcgetattr(file_.get(), &raw) != 0) {
            throw Error(place, "port", fmt::format("'{}' is not a serial line", options.port),
                        "Name one, e.g. /dev/ttyUSB0.");
        }
        cfmakeraw(&raw);
        cfsetspeed(&raw, speed_of(options.baud));
        raw.c_cflag |= CLOCAL | CREAD;
        if (tcsetattr(file_.get(), TCSANOW, &raw) != 0) {
            throw Error(place, "baud",
                        fmt::format("'{}' does not support {} baud", options.port, options.baud),
                        "Use a speed from its manual.");
        }
        tcflush(file_.get(), TCIOFLUSH);
    }
    ~Serial() override {
        if (release_) send(0, std::nothrow);
    }
    Serial(const Serial&) = delete;
    Serial& operator=(const Serial&) = delete;

    void mark(int code, Clock::time_point) override {
        send(code);
        if (options_.hold > 0)
            release_ = Clock::now() + std::chrono::duration_cast<Clock::duration>(
                                          std::chrono::duration<double>(options_.hold));
    }
    int tend(Clock::time_point now) override {
        if (release_ && now >= *release_) {
            release_.reset();
            send(0);
        }
        int code = 0;
        std::array<unsigned char, 64> received;
        while (true) {
            const ssize_t count = read(file_.get(), received.data(), received.size());
            if (count < 0 && (errno == EAGAIN || errno == EINTR)) break;
            if (count <= 0) {  // 0: the line was hung up
                throw Error(fmt::format("{} cannot be read: {}", options_.port,
                                        count < 0 ? strerror(errno) : "it was unplugged"),
                            "Check the line.");
            }
            for (ssize_t i = 0; i < count && code == 0; ++i)
                code = received[static_cast<size_t>(i)];
        }
        return code;
    }

  private:
    bool send(int code, const std::nothrow_t&) noexcept {
        const auto byte = static_cast<unsigned char>(code);
        return write(file_.get(), &byte, 1) == 1;
    }
    void send(int code) {
        if (!send(code, std::nothrow))
            throw Error(fmt::format("code {} could not be written to {}: {}", code, options_.port,
                                    strerror(errno)),
                        "Check the line.");
    }

    Options options_;
    Descriptor file_;
    std::optional<Clock::time_point> release_;
};

void check(const OutletConfig& config, Diagnostics& diagnostics) {
    read_options(config, diagnostics);
}

std::unique_ptr<Outlet> make(const OutletConfig& config, const About&) {
    Diagnostics diagnostics;
    const Options options = read_options(config, diagnostics);
    diagnostics.throw_if_errors();
    return std::make_unique<Serial>(options, config.place);
}

}  // namespace

Kind kind() {
    return {"serial", check, make, false, true, [](JsonSchema& schema) {
                schema.part_of_kind("options", "serial", "Options.serial", Options{});
            }};
}

}  // namespace dihaptic::outlets::serial
