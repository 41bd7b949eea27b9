#include "summary.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "base/plural.h"
#include "base/unit.h"
#include "command.h"

namespace dihaptic::cli {
namespace {

std::string number(double value, int decimals) {
    return std::isnan(value) ? "-" : fmt::format("{:.{}f}", value, decimals);
}

/// Describes the figures of an episode in words.
std::string describe(const analysis::Episode& e) {
    std::string out;
    const auto add = [&](double value, const std::string& text) {
        if (!std::isnan(value)) out += (out.empty() ? "" : "; ") + text;
    };
    add(e.slip, fmt::format("slip {:.4f} mm", e.slip * 1e3));
    if (e.slip - e.least_slip >= 1e-7)
        add(e.least_slip, fmt::format("least {:.4f} mm", e.least_slip * 1e3));
    add(e.sag, fmt::format("sank {:.4f} mm", std::abs(e.sag) * 1e3));
    if (e.hand_turn / kDegree >= 5) {
        add(e.turn, fmt::format("turned {:.2f} deg, {:.4f} of the hand's turn", e.turn / kDegree,
                                e.turn / e.hand_turn));
    }
    add(e.distance, fmt::format("{:.2f} mm", e.distance * 1e3));
    add(e.friction_ratio, fmt::format("friction {:.4f} of mu N", e.friction_ratio));
    add(e.release_speed, fmt::format("let go at {:.4f} m/s", e.release_speed));
    add(e.release_ratio, fmt::format("{:.4f} of the hand's speed", e.release_ratio));
    add(e.rise, fmt::format("rose {:.2f} mm", e.rise * 1e3));
    add(e.off_path, fmt::format("{:.6f} mm off the ballistic path", e.off_path * 1e3));
    return out;
}

void print_episodes(const analysis::SessionFigures& figures) {
    if (figures.episodes.empty()) return;
    constexpr size_t kMost = 20;
    fmt::print("{:10s} {:>7s} {:>7s}  of the object\n", "episode", "from s", "to s");
    for (size_t i = 0; i < figures.episodes.size() && i < kMost; ++i) {
        const analysis::Episode& e = figures.episodes[i];
        fmt::print("{:10s} {:7.2f} {:7.2f}  {}{}{}\n", enum_name(e.kind), e.start, e.end,
                   e.finger_names, e.finger_names.empty() ? "" : ": ", describe(e));
    }
    if (figures.episodes.size() > kMost)
        fmt::print("and {} more, in episodes.csv\n", figures.episodes.size() - kMost);
    fmt::print("\n");
}

}  // namespace

void print_movement(const session::MovementReport& report, size_t most_lines) {
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

namespace {

/// The trials of one kind in one block.
struct Block {
    std::string key;  // block number and kind of trial
    std::string label;
    std::map<std::string, int> outcomes;
    double sum = 0;  // sum of the hand's angles or extents
    int measured = 0;
};

/// Groups the trials by block and kind. `extents`: set to whether the extent of the hand's movement
/// was measured instead of its angle.
std::vector<Block> blocks_of(const Table& trials, bool& extents) {
    const auto column = [&](const char* name) {
        const auto found = std::find_if(trials.columns.begin(), trials.columns.end(),
                                        [&](const auto& c) { return c.name == name; });
        return static_cast<size_t>(found - trials.columns.begin());
    };
    const auto text = [](const Table::Cell& cell) {
        const auto* value = std::get_if<double>(&cell);
        return value != nullptr ? fmt::format("{:g}", *value) : std::get<std::string>(cell);
    };
    std::vector<Block> blocks;
    for (const auto& row : trials.rows) {
        const std::string number = text(row[column("block_num")]);
        const std::string kind = text(row[column("kind")]);
        auto block = std::ranges::find(blocks, number + kind, &Block::key);
        if (block == blocks.end()) {
            const std::string label =
                fmt::format("{:>3s} {:10s} {:12s} {:12s}", number, text(row[column("round")]),
                            text(row[column("block")]), kind);
            block = blocks.insert(blocks.end(), {number + kind, label, {}, 0, 0});
        }
        ++block->outcomes[text(row[column("outcome")])];
        const auto value = [&](const char* name) {
            const auto* cell = std::get_if<double>(&row[column(name)]);
            return cell == nullptr ? NAN : *cell;
        };
        const double extent = value("hand_extent_mm");
        extents = extents || !std::isnan(extent);
        const double measured = std::isnan(extent) ? value("hand_angle_deg") : extent;
        if (std::isnan(measured)) continue;
        block->sum += measured;
        ++block->measured;
    }
    return blocks;
}

/// Prints a row for each block and kind of trial, with the outcomes and the mean angle or extent of
/// the hand.
void print_trials(const Table& trials) {
    bool extents = false;
    const std::vector<Block> blocks = blocks_of(trials, extents);
    const bool reaches =
        std::ranges::any_of(blocks, [](const Block& block) { return block.measured > 0; });
    const auto of_hand = [&](const std::string& value) {
        return reaches ? fmt::format("{:>10s}  ", value) : "";
    };
    fmt::print("\n{:>3s} {:10s} {:12s} {:12s} {}outcomes\n", "", "round", "block", "kind",
               of_hand(extents ? "hand mm" : "hand deg"));
    for (const Block& block : blocks) {
        std::string outcomes;
        for (const auto& [name, count] : block.outcomes)
            outcomes += fmt::format("{}{} {}", outcomes.empty() ? "" : ", ", count, name);
        const double mean = block.measured > 0 ? block.sum / block.measured : NAN;
        fmt::print("{} {}{}\n", block.label, of_hand(number(mean, 2)), outcomes);
    }
    fmt::print("\n");
    if (!reaches) return;
    fmt::print("hand: mean {}; trials.csv gives it for each trial\n",
               extents ? "length of the handle's first stroke toward the target"
                       : "angle of the handle from the target's direction");
}

void print_phases(const analysis::SessionFigures& figures) {
    const bool turns = !figures.phases.empty() && !std::isnan(figures.phases.front().peak_torque);
    fmt::print("\n{:10s} {:>7s} {:>7s}  {:>9s} {:>10s} {:>9s}  {:>10s} {:>10s}  {:>8s}  {:>9s}{}\n",
               "phase", "from s", "to s", "grip N", "its peak N", "load N", "finger N",
               "its peak N", "slip mm", "weight", turns ? "  torque mN m" : "");
    for (const rows::PhaseRow& p : figures.phases) {
        fmt::print(
            "{:10s} {:7.2f} {:7.2f}  {:>9s} {:>10s} {:>9s}  {:>10s} {:>10s}  {:>8s}  {:>9s}{}\n",
            p.name, p.start, p.end, number(p.mean_grip, 3), number(p.peak_grip, 3),
            number(p.mean_load, 3), number(p.mean_force, 3), number(p.peak_force, 3),
            number(p.slip * 1e3, 4), number(p.weight_felt, 4),
            turns ? fmt::format("  {:11.2f}", p.mean_torque * 1e3) : "");
    }
    fmt::print(
        "\ngrip: pinch force, mean over digits; load: tangential force along gravity, both digits; "
        "finger: force on\nthe busiest handle; slip: of a finger on the object; weight: vertical "
        "handle forces over the object's weight{}\n\n",
        turns ? "; torque: largest on any handle, mean" : "");
    print_episodes(figures);
}

}  // namespace

void print_summary(const session::Recorded& session, const session::Plan& plan) {
    const analysis::SessionFigures& figures = session.figures;
    if (figures.trials) {
        print_trials(*figures.trials);
    } else {
        print_phases(figures);
    }
    for (const std::string& note : session.notes) fmt::print("{}\n", note);
    fmt::print("{}\n", figures.convergence.describe());
    const servo::Timing& timing = session.timing;
    const double speed = session.simulated / session.elapsed;
    fmt::print(
        "{:.2f} s in {:.2f} s ({:.{}f} times real time); tick {:.1f} us median, {:.1f} us p99",
        session.simulated, session.elapsed, speed, speed < 10 ? 1 : 0, timing.ticks.quantile(0.5),
        timing.ticks.quantile(0.99));
    // on the virtual clock, a tick is never late, however long it takes
    if (timing.lateness.count() > 0)
        fmt::print(", {:.1f} us max; period {:.0f} us\n{}; {}", timing.ticks.quantile(1),
                   plan.settings.tick() * 1e6, describe(timing),
                   counted(timing.overruns, "overrun"));
    fmt::print("\n");
    if (session.interrupted)
        fmt::print("interrupted: the recording is complete up to that moment\n");
    fmt::print("{}\n", session.info.moved_by.describe());
    fmt::print("session: {}\n", session.folder);
}

}  // namespace dihaptic::cli
