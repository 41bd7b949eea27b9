#include "host/force_off.h"

#include <array>
#include <ctime>

namespace dihaptic::host {
namespace {

/// The pages of the active devices. A program has one group of devices, rarely two.
std::array<std::atomic<SharedPage*>, 4> pages{};

}  // namespace

void watch_over(SharedPage* page) noexcept {
    for (auto& place : pages) {
        SharedPage* none = nullptr;
        if (place.compare_exchange_strong(none, page)) return;
    }
}

void forget(SharedPage* page) noexcept {
    for (auto& place : pages) {
        SharedPage* mine = page;
        if (place.compare_exchange_strong(mine, nullptr)) return;
    }
}

bool await_off(const SharedPage& page, int64_t since) noexcept {
    constexpr timespec kMoment{0, 20'000};
    while (page.off.load() == 0) {
        if (monotonic() - since >= kLastWait.count()) return false;
        nanosleep(&kMoment, nullptr);
    }
    return true;
}

bool force_off_now() noexcept {
    for (const auto& place : pages) {
        if (SharedPage* const page = place.load(); page != nullptr) end_force(*page);
    }
    const int64_t since = monotonic();
    bool all = true;
    for (const auto& place : pages) {
        const SharedPage* const page = place.load();
        all = (page == nullptr || await_off(*page, since)) && all;
    }
    return all;
}

}  // namespace dihaptic::host
