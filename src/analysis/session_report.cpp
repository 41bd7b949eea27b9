#include "analysis/session_report.h"

#include <cmath>
#include <filesystem>
#include <limits>
#include <map>

#include "analysis/events.h"
#include "analysis/grasp_trace.h"
#include "recording/nwb.h"
#include "recording/raw_log.h"
#include "scene/scene.h"

namespace dihaptic::analysis {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

/// What reading the log once gives.
struct Reading {
    SessionFigures figures;
    std::vector<Event> events;
};

PhaseFigures figures_of(const GraspTrace& trace, Range range, double weight) {
    PhaseFigures out;
    out.start = trace.samples()[range.first].time;
    out.end = trace.samples()[range.last - 1].time;
    out.mean_grip = trace.mean_grip(range);
    out.peak_grip = trace.fingers() > 1 ? trace.peak_grip(range) : kNaN;
    out.mean_load = trace.mean_load(range);
    out.mean_force = trace.mean_force(range);
    out.peak_force = trace.peak_force(range);
    const bool held = trace.all_touching(range);
    bool carried = held && weight > 0;
    for (size_t i = range.first; i < range.last && carried; ++i)
        carried = !trace.samples()[i].on_support;
    out.slip = held ? trace.slip(range) : kNaN;
    out.weight_felt = carried ? trace.weight_felt(range) / weight : kNaN;
    return out;
}

Reading read(const recording::SessionFolder& folder, const recording::SessionInfo& info,
             const std::function<void(double)>& progress) {
    recording::RawLogReader log(folder.raw_log());
    Diagnostics diagnostics;
    const scene::Scene scene = scene::read_scene(folder.file("scene.yaml"), diagnostics);
    diagnostics.throw_if_errors();
    const int object = info.object.empty() ? -1 : scene.find(info.object);
    const double weight =
        object < 0 ? 0
                   : scene::mass(scene.bodies[static_cast<size_t>(object)]) * scene.gravity.norm();

    std::vector<std::string> names;
    for (const recording::PhaseInfo& phase : info.phases) names.push_back(phase.name);
    EventFinder events(log.head(), object, names);
    GraspTrace trace(object, log.head().tick);
    Reading out;
    SessionFigures& figures = out.figures;
    figures.status_ticks.assign(servo::kStatusBits, 0);

    int trial = 0;
    int phase = -1;
    size_t first = 0;
    const auto close_phase = [&] {
        const Range range{first, trace.samples().size()};
        if (phase < 0 || range.size() == 0) return;
        PhaseFigures figure = figures_of(trace, range, weight);
        figure.trial = trial;
        const auto i = static_cast<size_t>(phase);
        figure.name = i < names.size() ? names[i] : std::to_string(phase);
        figures.phases.push_back(figure);
    };
    const auto size = static_cast<double>(std::filesystem::file_size(folder.raw_log()));
    int64_t expected = 0;
    while (const servo::Frame* frame = log.next()) {
        if (frame->phase != phase || frame->trial != trial) {
            close_phase();
            phase = frame->phase;
            trial = frame->trial;
            first = trace.samples().size();
        }
        trace.add(*frame);
        events.add(*frame);
        figures.missing += frame->sequence - expected;
        expected = frame->sequence + 1;
        ++figures.frames;
        figures.duration = seconds(frame->time);
        figures.status |= frame->status;
        for (int bit = 0; bit < servo::kStatusBits; ++bit) {
            figures.status_ticks[static_cast<size_t>(bit)] += (frame->status >> bit) & 1u;
        }
        if (progress && figures.frames % 5000 == 0)
            progress(std::min(0.99, static_cast<double>(figures.frames) * 1000 / size));
    }
    close_phase();
    figures.complete = log.complete();
    figures.damaged_bytes = log.damaged_bytes();
    out.events = events.events();
    return out;
}

Table phase_table(const SessionFigures& figures) {
    Table table;
    table.columns = {
        {"start_time", "s"},
        {"stop_time", "s"},
        {"trial", "number, from 1"},
        {"phase", "name"},
        {"mean_grip_N", "pinch component of the normal forces, mean of the digits"},
        {"peak_grip_N", "largest grip force"},
        {"mean_load_N", "tangential contact forces along gravity, summed over the digits"},
        {"mean_force_N", "mean force on the busiest finger"},
        {"peak_force_N", "largest force on any finger"},
        {"slip_mm", "largest slip of a finger on the object; empty unless all held it throughout"},
        {"weight_felt", "vertical handle forces over the object's weight; empty unless carried"}};
    for (const PhaseFigures& p : figures.phases) {
        table.rows.push_back({p.start, p.end, static_cast<double>(p.trial), p.name, p.mean_grip,
                              p.peak_grip, p.mean_load, p.mean_force, p.peak_force, p.slip * 1e3,
                              p.weight_felt});
    }
    return table;
}

Table trial_table(const SessionFigures& figures, const recording::SessionInfo& info) {
    Table table;
    table.columns = {{"start_time", "s"},
                     {"stop_time", "s"},
                     {"experiment", "title"},
                     {"ppid", "participant"},
                     {"session_num", "number, from 1"},
                     {"trial_num", "number in the session, from 1"},
                     {"block_num", "number, from 1"},
                     {"trial_num_in_block", "number, from 1"},
                     {"outcome", "done, interrupted, or diverged"},
                     {"peak_grip_N", "largest grip force"},
                     {"peak_force_N", "largest force on any finger"}};
    std::map<int, std::vector<const PhaseFigures*>> by_trial;
    for (const PhaseFigures& phase : figures.phases) by_trial[phase.trial].push_back(&phase);
    for (const auto& [trial, phases] : by_trial) {
        double grip = kNaN;
        double force = 0;
        for (const PhaseFigures* phase : phases) {
            grip = std::fmax(grip, phase->peak_grip);
            force = std::max(force, phase->peak_force);
        }
        const bool done = phases.back()->name == info.phases.back().name && figures.complete &&
                          info.state != recording::SessionState::interrupted;
        table.rows.push_back({phases.front()->start, phases.back()->end, info.title,
                              info.participant.id, 1.0, static_cast<double>(trial), 1.0,
                              static_cast<double>(trial),
                              figures.diverged() ? "diverged"
                              : done             ? "done"
                                                 : "interrupted",
                              grip, force});
    }
    return table;
}

Table event_table(const std::vector<Event>& events) {
    Table table;
    table.columns = {{"time_s", ""}, {"trial", ""}, {"event", ""}, {"detail", ""}};
    for (const Event& event : events) {
        table.rows.push_back(
            {event.time, static_cast<double>(event.trial), event.name, event.detail});
    }
    return table;
}

Table read_csv_settings(const recording::SessionFolder& folder) {
    // settings.csv is this program's own: three cells a line, quoted where they must be
    Table table;
    table.columns = {{"setting", "name and unit"},
                     {"value", "as used"},
                     {"origin", "file and line, or default"}};
    for (std::vector<std::string>& row : read_csv(folder.file("settings.csv"))) {
        row.resize(3);
        table.rows.push_back({row[0], row[1], row[2]});
    }
    if (!table.rows.empty()) table.rows.erase(table.rows.begin());  // its header
    return table;
}

}  // namespace

const PhaseFigures* SessionFigures::phase(const std::string& name) const {
    for (const PhaseFigures& phase : phases) {
        if (phase.name == name) return &phase;
    }
    return nullptr;
}

SessionFigures read_figures(const recording::SessionFolder& folder,
                            const std::function<void(double)>& progress) {
    return read(folder, folder.read_info(), progress).figures;
}

SessionFigures finish_session(const recording::SessionFolder& folder,
                              const std::function<void(double)>& progress) {
    recording::NwbContent content;
    content.info = folder.read_info();
    const auto part = [&](double from, double to) {
        return [=](double share) {
            if (progress) progress(from + share * (to - from));
        };
    };
    const Reading reading = read(folder, content.info, part(0, 0.4));
    content.trials = trial_table(reading.figures, content.info);
    content.phases = phase_table(reading.figures);
    content.settings = read_csv_settings(folder);
    write_csv(content.trials, folder.file("trials.csv"));
    write_csv(content.phases, folder.file("phases.csv"));
    write_csv(event_table(reading.events), folder.file("events.csv"));
    recording::write_nwb(folder, content, part(0.4, 1));
    return reading.figures;
}

}  // namespace dihaptic::analysis
