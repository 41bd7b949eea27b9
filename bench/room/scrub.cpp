#include "bench/scrub.h"

#include <algorithm>
#include <optional>

#include "base/random.h"
#include "base/statistics.h"
#include "bench/duration.h"
#include "recording/log_browser.h"
#include "recording/session.h"

namespace dihaptic::bench {
namespace {

constexpr int kJumps = 500;
constexpr int kScrubbedTicks = 5000;

}  // namespace

ScrubFigures bench_scrub(const std::string& session, const measure::Progress& progress) {
    const std::string log = recording::SessionFolder::open(session).raw_log();
    std::optional<recording::LogBrowser> browser;
    ScrubFigures out;
    out.open_ms = 1e3 * duration_of([&] { browser.emplace(log); });
    out.duration = browser->end() - browser->begin();
    Random random(1, "scrub");
    std::vector<double> jumps;
    for (int i = 0; i < kJumps; ++i) {
        const double to = random.uniform(browser->begin(), browser->end());
        jumps.push_back(duration_of([&] { browser->at(to); }));
        if (progress) progress("jumps", static_cast<double>(i) / kJumps);
    }
    std::vector<double> ticks;
    browser->at(browser->begin());
    for (int i = 0; i < kScrubbedTicks; ++i) {
        bool there = true;
        const double took = duration_of([&] { there = browser->next() != nullptr; });
        if (!there) break;
        ticks.push_back(took);
    }
    out.worst_jump_ms = 1e3 * *std::max_element(jumps.begin(), jumps.end());
    out.jump_ms = 1e3 * quantile(jumps, 0.5);
    out.next_us = 1e6 * quantile(ticks, 0.5);
    return out;
}

}  // namespace dihaptic::bench
