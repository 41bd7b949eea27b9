#include "outlets/station.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>

namespace dihaptic::outlets {
namespace {

/// Precedes the values of each tick in the ring.
struct Head {
    Clock::rep at;
    int32_t code;
};

constexpr auto kTend = std::chrono::milliseconds(1);
/// Capacity of the ring [ticks]: holds a few seconds of ticks if an outlet hangs.
constexpr size_t kTicks = 8192;

}  // namespace

Station::Station(const std::vector<OutletConfig>& outlets, const About& about)
    : channels_(about.channels.size()),
      ring_(kTicks * (sizeof(uint32_t) + sizeof(Head) + channels_ * sizeof(float))),
      sent_(sizeof(Head) + channels_ * sizeof(float)) {
    for (const OutletConfig& config : outlets) {
        const Kind& kind = *find_kind(config.kind);
        lines_.push_back({config.kind, kind.make(config, about), kind.samples});
        samples_ = samples_ || kind.samples;
    }
    thread_ = std::thread([this] { run(); });
}

Station::~Station() {
    finish();
}

void Station::send(int code, std::span<const float> values) noexcept {
    if (code == 0 && !samples_) return;
    const Head head{Clock::now().time_since_epoch().count(), code};
    const size_t count = samples_ ? std::min(values.size(), channels_) : 0;
    std::memcpy(sent_.data(), &head, sizeof head);
    const auto raw = std::as_bytes(values.first(count));
    std::copy(raw.begin(), raw.end(), sent_.begin() + sizeof head);
    const std::span<const std::byte> bytes(sent_.data(), sizeof head + count * sizeof(float));
    if (!ring_.push(bytes)) lost_.fetch_add(1, std::memory_order_relaxed);
    if (code != 0) marked_.release();
}

template <class Call>
void Station::call(Line& line, const Call& call) {
    if (!line.outlet) return;
    try {
        call(*line.outlet);
    } catch (const Error& e) {
        failures_.push_back(
            fmt::format("{}: {} From then on no data were exchanged with it; all event codes "
                        "are in events.csv.",
                        line.kind, e.what()));
        line.outlet.reset();
    }
}

void Station::drain() {
    std::vector<float> values;
    while (ring_.pop(received_)) {
        Head head;
        std::memcpy(&head, received_.data(), sizeof head);
        const Clock::time_point at{Clock::duration(head.at)};
        values.resize((received_.size() - sizeof head) / sizeof(float));
        std::copy(received_.begin() + sizeof head, received_.end(),
                  std::as_writable_bytes(std::span(values)).begin());
        for (Line& line : lines_) {
            call(line, [&](Outlet& outlet) {
                if (head.code != 0) outlet.mark(head.code, at);
                if (line.samples && values.size() == channels_) outlet.sample(values, at);
            });
        }
    }
}

void Station::run() {
    while (!done_.load()) {
        (void)marked_.try_acquire_for(kTend);
        drain();
        for (Line& line : lines_) {
            call(line, [&](Outlet& outlet) {
                if (const int code = outlet.tend(Clock::now())) trigger_.store(code);
            });
        }
    }
    drain();
}

std::vector<std::string> Station::finish() {
    done_.store(true);
    if (thread_.joinable()) thread_.join();
    lines_.clear();
    if (const int64_t lost = lost_.exchange(0); lost > 0)
        failures_.push_back(
            fmt::format("{} ticks did not reach the outlets, which were too slow; the event codes "
                        "of these ticks are in events.csv.",
                        lost));
    return failures_;
}

}  // namespace dihaptic::outlets
