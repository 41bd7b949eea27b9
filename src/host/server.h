// The server in the device host, which serves the ticks of its devices and switches their force
// off.
//
// It has two threads. One serves the program's requests during the ticks, when it alone reads and
// writes the devices. The other watches the first, and stops the devices when a call to the
// manufacturer's library hangs.
#pragma once

#include <atomic>
#include <memory>
#include <thread>

#include "devices/device_claim.h"
#include "host/host.h"
#include "host/order.h"
#include "host/shared_page.h"

namespace dihaptic::host {

class Server {
  public:
    /// Makes the devices. Throws Error with the backend's message if that fails.
    Server(SharedPage& page, const Order& order, const InRealTime& in_real_time);
    ~Server();
    Server(const Server&) = delete;
    Server& operator=(const Server&) = delete;

    const devices::DeviceGroup& devices() const { return *devices_; }
    /// Switches the devices on and starts serving. Throws Error if the devices cannot be switched
    /// on.
    void activate();
    /// Ends the threads, switches force off, and then switches the devices off.
    void deactivate();
    std::string explain(int device) const { return devices_->explain(device); }
    /// Stops the devices when the device host itself is about to die. It is unknown whether a
    /// manufacturer's library can be called from a signal handler, but there is no other way.
    void stop_at_death() noexcept {
        if (devices_->active() && devices_->can_stop()) devices_->stop();
    }

  private:
    class Call;

    void serve_all() noexcept;
    void serve(Request request) noexcept;
    bool take_turn() noexcept;
    bool end_turn(bool replied) noexcept;
    bool overslept_since(int64_t time) const noexcept;
    bool await_reply() noexcept;
    void read(Time now) noexcept;
    void write() noexcept;
    void write_zero() noexcept;
    void take_force_away() noexcept;
    void switch_off() noexcept;
    void watch() noexcept;
    bool ended() const noexcept { return page_.ended.load(std::memory_order_acquire) != 0; }

    SharedPage& page_;
    const InRealTime& in_real_time_;
    Time longest_silence_;
    Time tick_;
    int priority_;
    std::string backend_;
    std::vector<Place> places_;  // by device
    std::unique_ptr<devices::DeviceGroup> devices_;
    std::vector<devices::DeviceClaim> claims_;  // held while the devices are active
    std::vector<devices::Reading> readings_;
    std::vector<Wrench> wrenches_;
    std::atomic<bool> holding_{false};  // whether the devices may hold a nonzero force
    uint32_t replied_ = 0;              // SharedPage::replied at the start of this turn
    bool behind_ = false;               // whether the program missed the previous turn
    Time turn_time_{0};                 // time of this turn, counted in ticks
    int64_t turned_ = 0;                // time at which the last turn ended, from monotonic()
    // time at which a call to the devices started, from monotonic(); 0 if there is no call
    std::atomic<int64_t> busy_since_{0};
    std::atomic<bool> watching_{false};
    std::thread serving_;
    std::thread watcher_;
};

}  // namespace dihaptic::host
