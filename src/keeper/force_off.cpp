#include "keeper/force_off.h"

#include <array>
#include <ctime>

namespace dihaptic::keeper {
namespace {

/// A program has one group of devices, rarely two.
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

bool force_off_now() noexcept {
    for (const auto& place : pages) {
        SharedPage* const page = place.load();
        if (page == nullptr) continue;
        end_force(*page);
    }
    const int64_t begin = monotonic();
    bool all = false;
    while (!all && monotonic() - begin < kLastWait.count()) {
        all = true;
        for (const auto& place : pages) {
            const SharedPage* const page = place.load();
            all = all && (page == nullptr || page->off.load() != 0);
        }
        constexpr timespec kMoment{0, 20'000};
        if (!all) nanosleep(&kMoment, nullptr);
    }
    return all;
}

}  // namespace dihaptic::keeper
