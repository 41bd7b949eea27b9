#include "bench/scrub.h"

#include <algorithm>
#include <chrono>
#include <optional>

#include "base/random.h"
#include "base/statistics.h"
#include "recording/log_browser.h"
#include "recording/session.h"

namespace dihaptic::bench {
namespace {

constexpr int kJumps = 500;
constexpr int kScrubbedTicks = 5000;

/// Duration of f() [s].
template <class F>
double time_of(const F& f) {
    const auto begin = std::chrono::steady_clock::now();
    f();
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

}  // namespace

ScrubFigures bench_scrub(const std::string& session, const measure::Progress& progress) {
    const std::string log = recording::SessionFolder::open(session).raw_log();
    std::optional<recording::LogBrowser> browser;
    ScrubFigures out;
    out.open_ms = 1e3 * time_of([&] { browser.emplace(log); });
    out.duration = browser->end() - browser->begin();
    Random random(1, "scrub");
    std::vector<double> jumps;
    for (int i = 0; i < kJumps; ++i) {
        const double to = random.uniform(browser->begin(), browser->end());
        jumps.push_back(time_of([&] { browser->at(to); }));
        if (progress) progress("jumps", static_cast<double>(i) / kJumps);
    }
    std::vector<double> ticks;
    browser->at(browser->begin());
    for (int i = 0; i < kScrubbedTicks; ++i) {
        bool there = true;
        const double took = time_of([&] { there = browser->next() != nullptr; });
        if (!there) break;
        ticks.push_back(took);
    }
    out.worst_jump_ms = 1e3 * *std::max_element(jumps.begin(), jumps.end());
    out.jump_ms = 1e3 * quantile(jumps, 0.5);
    out.next_us = 1e6 * quantile(ticks, 0.5);
    return out;
}

}  // namespace dihaptic::bench
