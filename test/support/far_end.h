// The far end of a simulated serial line, which is a pseudo-terminal.
#pragma once

#include <fcntl.h>
#include <gtest/gtest.h>
#include <pty.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <string>
#include <thread>
#include <vector>

namespace dihaptic::testing {

class FarEnd {
  public:
    FarEnd() {
        int near = -1;
        std::array<char, 256> name{};
        EXPECT_EQ(openpty(&file_, &near, name.data(), nullptr, nullptr), 0);
        port = name.data();
        close(near);
        fcntl(file_, F_SETFL, O_NONBLOCK);
    }
    ~FarEnd() { close(file_); }
    FarEnd(const FarEnd&) = delete;
    FarEnd& operator=(const FarEnd&) = delete;

    std::string port;  ///< path of the near end

    void send(unsigned char code) const { EXPECT_EQ(write(file_, &code, 1), 1); }
    /// The received codes, once there are `count` of them, or after two seconds.
    std::vector<int> receive(size_t count) const {
        std::vector<int> out;
        for (int i = 0; i < 2000 && out.size() < count; ++i) {
            unsigned char byte = 0;
            while (read(file_, &byte, 1) == 1) out.push_back(byte);
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
        }
        return out;
    }

  private:
    int file_ = -1;
};

}  // namespace dihaptic::testing
