#include "recording/log_health.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "base/plural.h"

namespace dihaptic::recording {

int64_t LogHealth::missing() const {
    int64_t sum = 0;
    for (const Gap& gap : gaps) sum += gap.ticks;
    return sum;
}

void LogHealth::note(Stray::Kind kind, int64_t count, int64_t bytes) {
    const auto same = [&](const Stray& stray) { return stray.kind == kind; };
    auto found = std::find_if(strays.begin(), strays.end(), same);
    if (found == strays.end()) found = strays.insert(found, {kind, 0, 0, last_time});
    found->count += count;
    found->bytes += bytes;
}

bool LogHealth::damaged(int64_t ticks) const {
    return !complete || written != frames || !strays.empty() || tail_bytes > 0 || tail_chunks > 0 ||
           last_tick + 1 < ticks || std::any_of(gaps.begin(), gaps.end(), [](const Gap& gap) {
               return gap.damaged_bytes > 0 || gap.chunks > 0;
           });
}

namespace {

std::string why(const Gap& gap) {
    if (gap.damaged_bytes > 0)
        return counted(gap.damaged_bytes, "byte") + " in the log are damaged there";
    if (gap.chunks > 0) return counted(gap.chunks, "chunk") + " missing from the log there";
    return "the recorder could not keep up";
}

std::string describe(const Stray& stray) {
    const std::string chunks = counted(stray.count, "chunk");
    const std::string bytes = counted(stray.bytes, "byte");
    const double from = seconds(stray.from);
    switch (stray.kind) {
        case Stray::Kind::moved:
            return fmt::format(
                "{} out of place in the log, from {:.3f} s on: used in the order of their numbers",
                chunks, from);
        case Stray::Kind::doubled:
            return fmt::format("{} in the log twice, from {:.3f} s on: used once", chunks, from);
        case Stray::Kind::foreign:
            return fmt::format(
                "{} from another session in the log ({}), from {:.3f} s on: left out", chunks,
                bytes, from);
        case Stray::Kind::after_end:
            return fmt::format("{} after the log's end mark, at {:.3f} s: left out", bytes, from);
        case Stray::Kind::no_chunk:
            return fmt::format("{} in the log that no recorder wrote, from {:.3f} s on: left out",
                               bytes, from);
        case Stray::Kind::no_frame:
            return fmt::format(
                "{} in the log with a correct checksum but an invalid frame, from {:.3f} s on: "
                "used up to that frame",
                chunks, from);
        case Stray::Kind::backwards:
            break;
    }
    return fmt::format("{} in the log no later than the previous one, from {:.3f} s on: left out",
                       counted(stray.count, "frame"), from);
}

void describe_gaps(std::vector<std::string>& out, const LogHealth& health) {
    constexpr size_t kMostGaps = 10;  // number of gaps listed; a longer list would not help
    for (size_t i = 0; i < health.gaps.size() && i < kMostGaps; ++i) {
        const Gap& gap = health.gaps[i];
        out.push_back(fmt::format("{} missing from tick {} on, between {:.3f} s and {:.3f} s: {}",
                                  counted(gap.ticks, "tick"), gap.first, seconds(gap.before),
                                  seconds(gap.after), why(gap)));
    }
    if (health.gaps.size() > kMostGaps) {
        out.push_back(
            fmt::format("{} like these; in all {} missing in between",
                        counted(static_cast<int64_t>(health.gaps.size() - kMostGaps), "more gap"),
                        counted(health.missing(), "tick")));
    }
}

void describe_end(std::vector<std::string>& out, const LogHealth& health, int64_t ticks,
                  double planned) {
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
    if (health.tail_chunks > 0) {
        out.push_back(fmt::format("{} missing before the log's end mark, after {:.3f} s",
                                  counted(health.tail_chunks, "chunk"), end));
    }
    if (health.complete && health.written >= 0 && health.written != health.frames) {
        out.push_back(fmt::format("the log's end mark states {}; {} were read",
                                  counted(health.written, "frame"), health.frames));
    }
    if (!health.complete && ticks == 0) {
        const std::string plan = planned > 0 ? fmt::format(" of {:.3f} s planned", planned) : "";
        out.push_back(
            fmt::format("the log ends without its end mark, at {:.3f} s{}: all later data are lost "
                        "(if the program was killed, at most 0.1 s of the session)",
                        end, plan));
    } else if (!health.complete) {
        out.push_back("the log ends without its end mark");
    }
}

}  // namespace

std::vector<std::string> describe(const LogHealth& health, int64_t ticks, double planned) {
    std::vector<std::string> out;
    describe_gaps(out, health);
    for (const Stray& stray : health.strays) out.push_back(describe(stray));
    describe_end(out, health, ticks, planned);
    return out;
}

std::vector<std::string> describe_version(const LogHealth& health) {
    std::vector<std::string> out;
    if (!health.not_recorded.empty()) {
        out.push_back(fmt::format(
            "another version made this recording: it did not record {}, which {} shown at the "
            "default everywhere",
            fmt::join(health.not_recorded, ", "), health.not_recorded.size() == 1 ? "is" : "are"));
    }
    if (!health.passed_over.empty()) {
        out.push_back(
            fmt::format("another version made this recording: its data on {} are left out",
                        fmt::join(health.passed_over, ", ")));
    }
    return out;
}

std::string describe_left_out(int64_t ticks, double period) {
    if (ticks == 0) return "";
    return fmt::format(
        "{} ({:.1f} ms) never took place: the servo was late, and continued with the next",
        counted(ticks, "tick"), static_cast<double>(ticks) * period * 1e3);
}

}  // namespace dihaptic::recording
