#include "summary.h"

#include <fmt/format.h>

#include <cmath>

#include "base/plural.h"
#include "command.h"

namespace dihaptic::cli {
namespace {

std::string number(double value, int decimals) {
    return std::isnan(value) ? "-" : fmt::format("{:.{}f}", value, decimals);
}

}  // namespace

analysis::SessionFigures finish(const experiment::RunResult& result) {
    ProgressLine line("writing session.nwb");
    return analysis::finish_session(recording::SessionFolder::open(result.folder), result.info,
                                    [&](double share) { line.show(share); });
}

void print_movement(const experiment::MovementReport& report, size_t most_lines) {
    fmt::print("movement {}: {:.2f} s, closed to {:.1f} mm at {:.2f} s, block {:.1f} mm wide\n",
               report.file, report.duration, report.site.aperture * 1e3, report.site.start,
               report.block_width * 1e3);
    fmt::print("bridged {:.1f} % of it, {}{}\n", 100 * report.bridged_share,
               counted(static_cast<int64_t>(report.faults.size()), "fault"),
               report.faults.empty() ? "" : ":");
    for (size_t i = 0; i < report.faults.size() && i < most_lines; ++i) {
        fmt::print("  line {}: {}\n", report.faults[i].line,
                   hand::describe(report.faults[i], report.fingers));
    }
    if (report.faults.size() > most_lines) {
        fmt::print("  and {} more, in movement-faults.csv\n", report.faults.size() - most_lines);
    }
}

void print_summary(const analysis::SessionFigures& figures, const experiment::Plan& plan,
                   const experiment::RunResult& result) {
    fmt::print("\n{:10s} {:>7s} {:>7s}  {:>9s} {:>9s} {:>9s}  {:>10s} {:>10s}  {:>8s}  {:>9s}\n",
               "phase", "from s", "to s", "grip N", "peak N", "load N", "finger N", "peak N",
               "slip mm", "weight");
    for (const analysis::PhaseFigures& p : figures.phases) {
        fmt::print(
            "{:10s} {:7.2f} {:7.2f}  {:>9s} {:>9s} {:>9s}  {:>10s} {:>10s}  {:>8s}  {:>9s}\n",
            p.name, p.start, p.end, number(p.mean_grip, 3), number(p.peak_grip, 3),
            number(p.mean_load, 3), number(p.mean_force, 3), number(p.peak_force, 3),
            number(p.slip * 1e3, 4), number(p.weight_felt, 4));
    }
    fmt::print(
        "\ngrip: pinch force, mean of the digits; load: tangential force along gravity, both "
        "digits; finger: force on\n"
        "the busiest handle; slip: of a finger on the object; weight: vertical handle forces over "
        "the object's weight\n\n");
    for (int bit = 0; bit < servo::kStatusBits; ++bit) {
        const int64_t ticks = figures.status_ticks[static_cast<size_t>(bit)];
        if (ticks == 0) continue;
        const servo::StatusText text = servo::describe(static_cast<servo::Status>(1u << bit));
        fmt::print("{}: in {} of {} {}{}\n", (1u << bit) == servo::kNotFinite ? "WARNING" : "note",
                   ticks, counted(figures.frames, "tick"), text.what,
                   text.remedy.empty() ? "" : ": " + text.remedy);
    }
    if (!result.fault.empty()) fmt::print("WARNING: {}\n", result.fault);
    if (!result.stall.empty()) fmt::print("WARNING: {}\n", result.stall);
    const servo::Timing& timing = result.timing;
    fmt::print(
        "{:.2f} s in {:.2f} s ({:.0f} times real time); tick {:.1f} us median, {:.1f} us p99, "
        "{:.1f} us max; period {:.0f} us\n",
        result.simulated, result.elapsed, result.simulated / result.elapsed,
        timing.ticks.quantile(0.5), timing.ticks.quantile(0.99), timing.ticks.quantile(1),
        plan.settings.tick() * 1e6);
    if (timing.lateness.count() > 0) {
        fmt::print("{}; {}\n", describe(timing), counted(timing.overruns, "overrun"));
    }
    if (result.dropped > 0) fmt::print("{} not recorded\n", counted(result.dropped, "frame"));
    if (figures.log.left_out > 0)
        fmt::print("{}\n", recording::describe_left_out(figures.log.left_out, figures.tick));
    if (result.interrupted) fmt::print("interrupted: what was done until then is complete\n");
    fmt::print("session: {}\n", result.folder);
}

}  // namespace dihaptic::cli
