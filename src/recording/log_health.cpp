#include "recording/log_health.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/plural.h"

namespace dihaptic::recording {

int64_t LogHealth::missing() const {
    int64_t sum = 0;
    for (const Gap& gap : gaps) sum += gap.ticks;
    return sum;
}

bool LogHealth::damaged(int64_t ticks) const {
    return !complete || tail_bytes > 0 || last_tick + 1 < ticks ||
           std::any_of(gaps.begin(), gaps.end(),
                       [](const Gap& gap) { return gap.damaged_bytes > 0; });
}

std::vector<std::string> describe(const LogHealth& health, int64_t ticks, double planned) {
    constexpr size_t kMostGaps = 10;  // more say no more
    std::vector<std::string> out;
    for (size_t i = 0; i < health.gaps.size() && i < kMostGaps; ++i) {
        const Gap& gap = health.gaps[i];
        const std::string why =
            gap.damaged_bytes > 0
                ? fmt::format("{} of the log are damaged there", counted(gap.damaged_bytes, "byte"))
                : "the recorder could not keep up";
        out.push_back(fmt::format("{} missing from tick {} on, between {:.3f} s and {:.3f} s: {}",
                                  counted(gap.ticks, "tick"), gap.first, seconds(gap.before),
                                  seconds(gap.after), why));
    }
    if (health.gaps.size() > kMostGaps) {
        out.push_back(
            fmt::format("{} like these; in all {} missing in between",
                        counted(static_cast<int64_t>(health.gaps.size() - kMostGaps), "more gap"),
                        counted(health.missing(), "tick")));
    }
    const int64_t at_end = ticks - 1 - health.last_tick;
    const double end = seconds(health.last_time);
    if (at_end > 0) {
        out.push_back(fmt::format("{} missing at the end, after {:.3f} s: the session had {}",
                                  counted(at_end, "tick"), end, counted(ticks, "tick")));
    }
    if (health.tail_bytes > 0) {
        out.push_back(fmt::format("{} at the log's end are {}, of about {}",
                                  counted(health.tail_bytes, "byte"),
                                  health.unfinished ? "an unfinished chunk" : "damaged",
                                  counted(health.tail_ticks, "tick")));
    }
    if (!health.complete && ticks == 0) {
        const std::string plan = planned > 0 ? fmt::format(" of {:.3f} s planned", planned) : "";
        out.push_back(
            fmt::format("the log ends without its end mark, at {:.3f} s{}: what came later is lost "
                        "(when the program was killed, at most 0.1 s of the session)",
                        end, plan));
    } else if (!health.complete) {
        out.push_back("the log ends without its end mark");
    }
    return out;
}

std::string describe_left_out(int64_t ticks, double period) {
    if (ticks == 0) return "";
    return fmt::format("{} ({:.1f} ms) never were: the servo was late, and went on with the next",
                       counted(ticks, "tick"), static_cast<double>(ticks) * period * 1e3);
}

}  // namespace dihaptic::recording
