#include "host/shared_page.h"

#include <linux/futex.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <climits>
#include <ctime>

namespace dihaptic::host {
namespace {

void futex(const std::atomic<uint32_t>& word, int what, uint32_t value, const timespec* most) {
    syscall(SYS_futex, reinterpret_cast<const uint32_t*>(&word), what, value, most, nullptr, 0);
}

}  // namespace

int64_t monotonic() noexcept {
    timespec now{};
    clock_gettime(CLOCK_MONOTONIC, &now);
    return now.tv_sec * 1'000'000'000L + now.tv_nsec;
}

void wait_on(const std::atomic<uint32_t>& word, uint32_t old, Time most) noexcept {
    if (most <= Time(0)) return;
    const timespec time{most.count() / 1'000'000'000L, most.count() % 1'000'000'000L};
    futex(word, FUTEX_WAIT, old, &time);
}

void wake(std::atomic<uint32_t>& word) noexcept {
    futex(word, FUTEX_WAKE, INT_MAX, nullptr);
}

void advance(std::atomic<uint32_t>& word) noexcept {
    word.fetch_add(1, std::memory_order_release);
    wake(word);
}

void end_force(SharedPage& page) noexcept {
    page.ended.store(1);
    wake(page.ended);
    advance(page.bell);
}

bool await_change(const std::atomic<uint32_t>& word, uint32_t old, Time most, Time hope) noexcept {
    const int64_t begin = monotonic();
    while (word.load(std::memory_order_acquire) == old) {
        const int64_t since = monotonic() - begin;
        if (since >= most.count()) return false;
        if (since >= hope.count()) wait_on(word, old, most - Time(since));
    }
    return true;
}

}  // namespace dihaptic::host
