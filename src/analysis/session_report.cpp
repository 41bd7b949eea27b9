#include "analysis/session_report.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <map>
#include <optional>

#include "analysis/corrections.h"
#include "analysis/events.h"
#include "analysis/fault_record.h"
#include "analysis/grasp_trace.h"
#include "analysis/lifts.h"
#include "analysis/measures/measures.h"
#include "analysis/perturbations.h"
#include "analysis/plausibility.h"
#include "analysis/trials.h"
#include "base/figure.h"
#include "base/number.h"
#include "base/plural.h"
#include "base/regular_file.h"
#include "base/unmeasured.h"
#include "recording/hearings.h"
#include "recording/log_scene.h"
#include "recording/nwb.h"
#include "recording/remarks.h"
#include "recording/seal.h"
#include "recording/showings.h"
#include "scene/scene.h"

namespace dihaptic::analysis {
namespace {

/// Everything found in one pass over the log.
struct Reading {
    SessionFigures figures;
    std::vector<rows::EventRow> events;
    Table fault;
    std::optional<TrialFinder> trials;  ///< only if the session has a task
    std::optional<MeasureFinder> measures;
    std::optional<CorrectionFinder> corrections;
    std::vector<rows::LiftRow> lifts;
    std::string why_no_facts;  ///< reason why the ObjectFacts are unknown; empty if they are known
};

rows::PhaseRow figures_of(const GraspTrace& trace, Range range, double weight) {
    rows::PhaseRow out;
    out.start = trace.samples()[range.first].time;
    out.end = trace.samples()[range.last - 1].time;
    out.mean_grip = trace.mean_grip(range);
    out.peak_grip = trace.fingers() > 1 ? trace.peak_grip(range) : kUnmeasured;
    out.mean_load = trace.mean_load(range);
    out.mean_force = trace.mean_force(range);
    out.peak_force = trace.peak_force(range);
    out.mean_torque = trace.mean_torque(range);
    out.peak_torque = trace.peak_torque(range);
    const bool held = trace.all_touching(range);
    bool carried = held && weight > 0;
    for (size_t i = range.first; i < range.last && carried; ++i)
        carried = !trace.samples()[i].on_support;
    // the object's pose may be unknown after damage to the log
    const bool known = trace.samples()[range.first].X_WB.p.allFinite();
    out.slip = held && known ? trace.slip(range) : kUnmeasured;
    const double now = weight * trace.mean_weight_scale(range);
    out.weight_felt = carried && now > 0 ? trace.weight_felt(range) / now : kUnmeasured;
    return out;
}

/// Returns what is known about the object. If nothing is known, sets `why` to the reason:
/// scene.yaml has changed or cannot be read.
ObjectFacts facts_of(const std::string& name, const recording::SessionFolder& folder,
                     const recording::LogHead& head, std::string& why) {
    if (name.empty()) return {};
    const std::string lost =
        "; figures that require the object's weight or friction are left empty";
    if (const auto changed = folder.changed(head.inputs, Severity::warning); !changed.empty()) {
        why = changed.front().place.file + " " + changed.front().what + lost;
        return {};
    }
    try {
        Diagnostics diagnostics(UnknownKeys::are_left_out);
        const scene::Scene scene = scene::read_scene(folder.file("scene.yaml"), diagnostics);
        const int i = scene.find(name);
        if (diagnostics.has_errors() || i < 0 || !recording::fits(head, scene)) {
            why = folder.file("scene.yaml") + " is not the scene in raw.log" + lost;
            return {};
        }
        const scene::Body& object = scene.bodies[static_cast<size_t>(i)];
        ObjectFacts facts;
        facts.mass = scene::mass(object);
        facts.gravity = scene.gravity;
        facts.flies = scene::flies(scene, object);
        for (const scene::Body& body : scene.bodies) {
            facts.friction.push_back(scene::pair_friction(scene, object.name, object.friction,
                                                          body.name, body.friction));
        }
        for (const scene::Finger& finger : scene.fingers) {
            facts.finger_friction.push_back(scene::pair_friction(
                scene, object.name, object.friction, finger.name, finger.friction));
        }
        return facts;
    } catch (const Error& e) {
        why = folder.file("scene.yaml") + " " + e.problems().front().what + lost;
        return {};
    }
}

/// Returns the name of the object in each trial: the object of the trial's condition or of its
/// round, or else `usual`. Empty if no condition has an object.
std::vector<std::string> objects_of_trials(const recording::SessionFolder& folder,
                                           const std::string& usual) {
    const task::Task task = read_frozen_task(folder.file("task.yaml"));
    std::map<std::string, std::string> by_round, by_condition;
    for (const task::Condition& c : task.rounds) {
        if (!c.object.empty()) by_round[c.name] = c.object;
    }
    for (const task::Condition& c : task.conditions) {
        if (!c.object.empty()) by_condition[c.name] = c.object;
    }
    std::vector<std::string> out;
    if (by_round.empty() && by_condition.empty()) return out;
    for (const rows::AskedRow& asked :
         rows::RowFile<rows::AskedRow>(folder.file("trial-list.csv"))) {
        const auto condition = by_condition.find(asked.condition);
        const auto round = by_round.find(asked.round);
        out.push_back(condition != by_condition.end() ? condition->second
                      : round != by_round.end()       ? round->second
                                                      : usual);
    }
    return out;
}

}  // namespace

/// Working data and results of one pass over the frames.
struct SessionReader::Pass {
    Pass(const recording::SessionFolder& folder, const recording::SessionInfo& of,
         const recording::LogHead& head)
        : info(of),
          names(names_of(of)),
          fingers(head.fingers),
          object(object_of(info.object, head)),
          tick(head.tick),
          facts(facts_of(info.object, folder, head, reading.why_no_facts)),
          events(head, object, names),
          trace(object, tick),
          fault(head.fingers, head.turning_fingers()),
          plausibility(of.moved_by.mover == recording::Mover::simulated_person, head.bodies,
                       head.tick) {
        reading.figures.status_ticks.assign(kStatusBits, 0);
        reading.figures.tick = tick;
        if (has_trials(folder)) {
            reading.trials.emplace(folder, head.fingers);
            reading.measures = MeasureFinder::of(folder, head, names);
            reading.corrections = CorrectionFinder::of(folder, head, names);
            for (const std::string& name : objects_of_trials(folder, info.object)) {
                objects.push_back(object_of(name, head));
                if (facts_by_object.count(objects.back()) == 0)
                    facts_by_object[objects.back()] =
                        facts_of(name, folder, head, reading.why_no_facts);
            }
        }
    }

    static std::vector<std::string> names_of(const recording::SessionInfo& info) {
        std::vector<std::string> out;
        for (const recording::PhaseInfo& phase : info.phases) out.push_back(phase.name);
        return out;
    }
    static int object_of(const std::string& name, const recording::LogHead& head) {
        const auto found = std::find(head.bodies.begin(), head.bodies.end(), name);
        return found == head.bodies.end() ? -1 : static_cast<int>(found - head.bodies.begin());
    }

    /// Selects the object of the trial that is starting.
    void begin_trial() {
        const auto i = static_cast<size_t>(trial - 1);
        if (trial < 1 || i >= objects.size() || objects[i] == object) return;
        object = objects[i];
        facts = facts_by_object[object];
        trace = GraspTrace(object, tick);
        events.follow(object);
    }

    void end_trial() {
        const size_t lifts = reading.lifts.size();
        if (object >= 0 && !trace.samples().empty()) {
            for (Episode& episode : find_episodes(trace, facts)) {
                std::vector<std::string> own;
                for (const size_t finger : episode.fingers) own.push_back(fingers[finger]);
                episode.finger_names = fmt::format("{}", fmt::join(own, ", "));
                reading.figures.episodes.push_back(std::move(episode));
            }
            // in a session with a task, phase 0 lies between trials
            if (trace.fingers() > 1 && !(reading.trials && phase == 0)) find_lifts();
        }
        if (reading.measures)
            reading.measures->end_attempt(reading.lifts.size() > lifts ? &reading.lifts.back()
                                                                       : nullptr);
        trace.restart();
    }

    /// Finds the lifts. An attempt at a trial counts as one lift; in a session without trials, a
    /// person may lift the object any number of times.
    void find_lifts() {
        const auto add = [&](const GraspTrace& of, int number) {
            rows::LiftRow lift = find_lift(of, facts.gravity, facts.finger_friction);
            lift.trial = trial;
            lift.attempt = number;
            reading.lifts.push_back(std::move(lift));
        };
        if (reading.trials) return add(trace, std::max(attempt, 1));
        const std::vector<Range> parts = lifts_in(trace, facts.gravity);
        for (size_t i = 0; i < parts.size(); ++i)
            add(trace.part(parts[i]), static_cast<int>(i) + 1);
    }

    void close_phase() {
        const Range range{first, trace.samples().size()};
        if (phase < 0 || range.size() == 0) return;
        rows::PhaseRow figure = figures_of(trace, range, facts.mass * facts.gravity.norm());
        figure.trial = trial;
        const auto i = static_cast<size_t>(phase);
        figure.name = i < names.size() ? names[i] : number_text(phase);
        reading.figures.phases.push_back(figure);
    }

    void add(const frame::Frame& frame) {
        // the feedback on the last trial of a session still belongs to that trial
        const bool next_trial = frame.trial != trial || frame.task.attempt != attempt ||
                                (reading.trials && (phase == 0) != (frame.phase == 0));
        if (frame.phase != phase || next_trial) {
            close_phase();
            if (next_trial) end_trial();  // starts a new trace, since objects are put back
            phase = frame.phase;
            attempt = frame.task.attempt;
            trial = frame.trial;
            if (next_trial) begin_trial();
            first = trace.samples().size();
        }
        trace.add(frame);
        if (reading.trials) reading.trials->add(frame);
        if (reading.measures) reading.measures->add(frame);
        if (reading.corrections) reading.corrections->add(frame);
        events.add(frame);
        fault.add(frame);
        SessionFigures& figures = reading.figures;
        ++figures.frames;
        figures.duration = seconds(frame.time);
        figures.status |= frame.status;
        for_each_status(frame.status, [&](Status bit) { ++figures.ticks_with(bit); });
        note_convergence(frame);
        plausibility.add(frame);
        // logs written before version 0.3 contain no balance
        if (std::isnan(frame.energy_imbalance)) return;
        figures.energy_imbalance += frame.energy_imbalance;
        figures.momentum_imbalance = std::max(figures.momentum_imbalance, frame.momentum_imbalance);
        figures.angular_imbalance = std::max(figures.angular_imbalance, frame.angular_imbalance);
    }

    void note_convergence(const frame::Frame& frame) {
        recording::Convergence& all = reading.figures.convergence;
        ++all.ticks;
        if ((frame.status & kSolverMissed) != 0) {
            ++all.missed;
            all.longest_run = std::max(all.longest_run, ++missed_in_a_row);
        } else {
            missed_in_a_row = 0;
        }
        const double residual = frame.solver_held_residual;
        if (std::isnan(residual) || (all.held_residual && residual <= *all.held_residual)) return;
        all.held_residual = residual;
        all.held_residual_time = seconds(frame.time);
    }

    void end(const recording::LogHealth& log) {
        close_phase();
        end_trial();
        reading.figures.log = log;
        reading.figures.implausible = plausibility.findings();
        reading.events = events.events();
        reading.fault = fault.table();
    }

    recording::SessionInfo info;
    std::vector<std::string> names;  // names of the phases
    std::vector<std::string> fingers;
    int object;
    double tick;
    Reading reading;
    ObjectFacts facts;
    std::vector<int> objects;  // object in each trial; empty if always the scene's object
    std::map<int, ObjectFacts> facts_by_object;
    EventFinder events;
    GraspTrace trace;
    FaultRecord fault;
    Plausibility plausibility;
    int trial = 0;
    int attempt = 0;
    int phase = -1;
    size_t first = 0;  // index of the first sample of the phase
    int missed_in_a_row = 0;
};

SessionReader::SessionReader(const recording::SessionFolder& folder,
                             const recording::SessionInfo& info, const recording::LogHead& head)
    : pass_(std::make_unique<Pass>(folder, info, head)) {}

SessionReader::SessionReader(SessionReader&&) noexcept = default;
SessionReader::~SessionReader() = default;

void SessionReader::add(const frame::Frame& frame) {
    pass_->add(frame);
}

Table SessionReader::trials() const {
    const Reading& reading = pass_->reading;
    if (!reading.trials) return {};
    Table out = reading.trials->table(pass_->info);
    if (reading.measures) reading.measures->add_to(out);
    return out;
}

size_t SessionReader::ended_trials() const {
    return pass_->reading.trials ? pass_->reading.trials->ended() : 0;
}

namespace {

Table trial_table(const SessionFigures& figures, const recording::SessionInfo& info) {
    std::map<int, rows::PlainTrialRow> trials;
    for (const rows::PhaseRow& phase : figures.phases) {
        const auto [found, is_new] = trials.try_emplace(phase.trial);
        rows::PlainTrialRow& trial = found->second;
        if (is_new) trial.head = {phase.start, 0, info.title, info.participant.id};
        trial.trial = phase.trial;
        trial.head.end = phase.end;
        trial.peak_grip = std::fmax(trial.peak_grip, phase.peak_grip);
        trial.peak_force = std::max(trial.peak_force, phase.peak_force);
        const bool ended = figures.log.complete || figures.log.last_tick + 1 == info.ticks;
        const bool done = ended && !info.interrupted && !info.phases.empty() &&
                          phase.name == info.phases.back().name;
        trial.outcome = figures.diverged() ? "diverged"
                        : figures.failed() ? "force off"
                        : done             ? "done"
                                           : "interrupted";
    }
    std::vector<rows::PlainTrialRow> rows;
    for (const auto& [number, trial] : trials) rows.push_back(trial);
    return figure_table<rows::PlainTrialRow>(rows);
}

/// Finds the time at which each event was first seen on the screen.
void find_shown(std::vector<rows::EventRow>& events, const recording::Showings& showings) {
    // a message can only be seen in pictures shown before the next message
    int64_t gone = recording::Showings::kStays;
    for (size_t i = events.size(); i-- > 0;) {
        rows::EventRow& event = events[i];
        const bool message = event.name == "message";
        event.shown =
            showings.onset(event.tick, event.time, message ? gone : recording::Showings::kStays);
        if (message) gone = event.tick;
    }
}

/// Finds the time at which each sound was heard.
void find_heard(std::vector<rows::EventRow>& events,
                const std::vector<recording::Hearing>& hearings) {
    std::map<std::pair<int64_t, std::string>, double> heard;
    for (const recording::Hearing& hearing : hearings)
        heard[{hearing.tick, hearing.sound}] = hearing.heard;
    for (rows::EventRow& event : events) {
        if (event.name != "sound") continue;
        const auto found = heard.find({event.tick, event.detail});
        if (found != heard.end()) event.heard = found->second;
    }
}

/// Adds the notes of the operator, in the order of time.
void add_remarks(std::vector<rows::EventRow>& events,
                 const std::vector<recording::Remark>& remarks) {
    for (const recording::Remark& remark : remarks)
        events.push_back({remark.tick, remark.time, remark.trial, rows::kNote, remark.text});
    std::ranges::stable_sort(events, {}, &rows::EventRow::tick);
}

/// Converts the table of events to the form required by NWB: intervals with a start and an end.
/// Notes of the operator, which may name a person, are left out.
Table as_intervals(const Table& events) {
    Table table;
    table.columns = {{"start_time", "from the session's start", "s"},
                     {"stop_time", "from the session's start", "s"}};
    table.columns.insert(table.columns.end(), events.columns.begin() + 1, events.columns.end());
    for (const std::vector<Table::Cell>& event : events.rows) {
        if (event[2] == Table::Cell(rows::kNote)) continue;
        std::vector<Table::Cell> row{event[0]};
        row.insert(row.end(), event.begin(), event.end());
        table.rows.push_back(row);
    }
    return table;
}

/// Returns the latest time in a session's table [s]; 0 if the table cannot be read. `time`:
/// function that returns the time of a row.
template <class Row, class Time>
double last_time(const std::string& file, Time time) {
    try {
        double last = 0;
        // std::max() ignores the NaN of a cell without a number
        for (const Row& row : rows::RowFile<Row>(file)) last = std::max(last, time(row));
        return last;
    } catch (const Error&) {
        return 0;
    }
}

/// Throws Error when existing files, which were made before the log was damaged, contain more data
/// than the log now yields.
void keep_longer_files(const recording::SessionFolder& folder, const SessionFigures& figures,
                       const std::vector<std::string>& damage) {
    std::vector<Problem> problems;
    const auto keep = [&](const std::string& name, const std::string& what) {
        problems.push_back({Severity::error,
                            {folder.file(name), 0},
                            "",
                            "contains more than the log now yields: " + what,
                            "To have it replaced, first move it away."});
    };
    const int64_t ticks = recording::ticks_in_nwb(folder);
    if (ticks > figures.frames) {
        keep("session.nwb", fmt::format("{}; the log has {}", counted(ticks, "tick"),
                                        counted(figures.frames, "tick")));
    }
    const auto check = [&](const char* name, double last) {
        if (last > figures.duration + figures.tick / 2) {
            keep(name, fmt::format("it extends to {:.3f} s; the log ends at {:.3f} s", last,
                                   figures.duration));
        }
    };
    const auto end = [](const auto& row) { return row.end; };
    // with a task, trials.csv also contains times from the sessions that this session resumes
    if (!has_trials(folder))
        check("trials.csv", last_time<rows::TrialHead>(folder.file("trials.csv"), end));
    check("phases.csv", last_time<rows::PhaseRow>(folder.file("phases.csv"), end));
    check("episodes.csv", last_time<rows::EpisodeRow>(folder.file("episodes.csv"), end));
    check("lifts.csv", last_time<rows::LiftRow>(folder.file("lifts.csv"),
                                                [](const auto& lift) { return lift.release; }));
    // a note may come from a tick that the log has lost
    const auto of_log = [](const auto& event) {
        return event.name == rows::kNote ? 0 : event.time;
    };
    check("events.csv", last_time<rows::EventRow>(folder.file("events.csv"), of_log));
    if (problems.empty()) return;
    for (const std::string& what : damage)
        problems.push_back({Severity::warning, {folder.raw_log(), 0}, "", what, ""});
    throw Error(problems);
}

}  // namespace

void add_note(recording::SessionInfo& info, const std::string& note) {
    if (std::find(info.notes.begin(), info.notes.end(), note) == info.notes.end())
        info.notes.push_back(note);
}

namespace {

Table no_settings() {
    Table table;
    table.columns = {{"setting", "name and unit"},
                     {"value", "value used"},
                     {"origin", "file and line, or default"}};
    return table;
}

/// Reads the settings. Returns no rows if they cannot be read, so that the rest of a damaged
/// session is not lost.
Table settings_left(const recording::SessionFolder& folder) {
    try {
        return read_settings(folder);
    } catch (const Error&) {
        return no_settings();
    }
}

}  // namespace

Table read_settings(const recording::SessionFolder& folder) {
    Table table = no_settings();
    const std::string file = folder.file("settings.csv");
    if (!is_there(file)) return table;
    for (std::vector<std::string>& row : read_csv(file)) {
        row.resize(3);
        table.rows.push_back({row[0], row[1], row[2]});
    }
    if (!table.rows.empty()) table.rows.erase(table.rows.begin());  // its header
    return table;
}

const rows::PhaseRow* SessionFigures::phase(const std::string& name) const {
    for (const rows::PhaseRow& phase : phases) {
        if (phase.name == name) return &phase;
    }
    return nullptr;
}

std::string SessionFigures::describe_imbalance() const {
    return fmt::format(
        "in {} of {} {}: by {:.2g} J in total, and by at most {:.2g} N*s and {:.2g} N*m*s for a "
        "body in a tick",
        ticks_with(kUnbalanced), counted(frames, "tick"), describe(kUnbalanced).what,
        energy_imbalance, momentum_imbalance, angular_imbalance);
}

namespace {

/// Adds notes to the session, and thus to its report, on how accurately its contacts were solved,
/// on unexplained movements of its objects, and on implausible movements.
void note_quality(recording::SessionInfo& info, const SessionFigures& figures) {
    info.convergence = figures.convergence;
    if (figures.ticks_with(kUnbalanced) > 0) add_note(info, figures.describe_imbalance());
    for (const std::string& what : figures.implausible) add_note(info, what);
}

/// Writes all tables except session.nwb. `conclude`: also writes the session's state, which marks
/// the session as complete.
SessionFigures write_tables(const recording::SessionFolder& folder, recording::SessionInfo info,
                            const Reading& reading, const recording::NwbContent& content,
                            const Table& events, bool conclude = true) {
    SessionFigures out = reading.figures;
    if (reading.trials) out.trials = with_earlier(content.trials, folder);
    write_csv(out.trials.value_or(content.trials), folder.file("trials.csv"));
    write_csv(content.phases, folder.file("phases.csv"));
    const auto by = [&](Table table) { return recording::marked(std::move(table), info.moved_by); };
    write_csv(by(figure_table<Episode>(out.episodes)), folder.file("episodes.csv"));
    if (!reading.lifts.empty())
        write_csv(by(figure_table<rows::LiftRow>(reading.lifts)), folder.file("lifts.csv"));
    if (reading.corrections)
        write_csv(by(figure_table<rows::CorrectionRow>(reading.corrections->rows())),
                  folder.file("corrections.csv"));
    write_csv(events, folder.file("events.csv"));
    if (!reading.fault.rows.empty()) write_csv(reading.fault, folder.file("fault.csv"));
    if (!conclude) return out;
    recording::seal(folder, info);
    folder.sync();  // all files must be on the disk before the state changes
    folder.write_info(info);
    return out;
}

recording::NwbContent content_of(const Reading& reading, const recording::SessionInfo& info,
                                 const recording::SessionFolder& folder) {
    recording::NwbContent content;
    content.info = info;
    const auto by = [&](Table table) { return recording::marked(std::move(table), info.moved_by); };
    content.trials =
        reading.trials ? reading.trials->table(info) : trial_table(reading.figures, info);
    if (reading.measures) reading.measures->add_to(content.trials);
    if (info.partner) {
        content.trials.columns.push_back(kPartnerColumn);
        for (std::vector<Table::Cell>& row : content.trials.rows)
            row.emplace_back(info.partner->id);
    }
    content.trials = by(std::move(content.trials));
    if (reading.trials) number_session(content.trials, folder);
    content.phases = by(figure_table<rows::PhaseRow>(reading.figures.phases));
    return content;
}

Table events_of(const Reading& reading, const recording::SessionFolder& folder,
                const recording::SessionInfo& info) {
    std::vector<rows::EventRow> events = reading.events;
    find_shown(events, recording::Showings(folder));
    find_heard(events, recording::read_hearings(folder));
    add_remarks(events, recording::read_remarks(folder));
    return recording::marked(figure_table<rows::EventRow>(events), info.moved_by);
}

}  // namespace

SessionFigures finish_session(const recording::SessionFolder& folder, recording::SessionInfo info,
                              const std::function<void(double)>& progress) {
    const auto part = [&](double from, double to) {
        return [=](double share) {
            if (progress) progress(from + share * (to - from));
        };
    };
    recording::RawLogReader log(folder.raw_log());
    SessionReader reader(folder, info, log.head());
    const auto progressed = part(0, 0.4);
    int64_t frames = 0;
    while (const frame::Frame* frame = log.next()) {
        reader.add(*frame);
        if (++frames % 5000 == 0) progressed(log.share());
    }
    reader.pass_->end(log.health());
    const Reading& reading = reader.pass_->reading;
    const SessionFigures& figures = reading.figures;
    const std::vector<std::string> damage =
        recording::describe(figures.log, info.ticks, info.planned());
    keep_longer_files(folder, figures, damage);
    if (figures.log.damaged(info.ticks)) info.state = recording::SessionState::recovered;
    for (const std::string& what : damage) add_note(info, what);
    for (const std::string& what : recording::describe_version(figures.log)) add_note(info, what);
    if (!reading.why_no_facts.empty()) add_note(info, reading.why_no_facts);
    note_quality(info, figures);
    if (info.ticks == 0) info.ticks = static_cast<int>(figures.log.last_tick + 1);

    recording::NwbContent content = content_of(reading, info, folder);
    const Table events = events_of(reading, folder, info);
    content.events = as_intervals(events);
    content.settings = settings_left(folder);
    try {
        recording::write_nwb(folder, content, part(0.4, 1));
    } catch (const Error&) {
        // if the disk is full, a second error must not hide the first
        try {
            write_tables(folder, info, reading, content, events, false);
        } catch (const Error&) {
        }
        throw;
    }
    return write_tables(folder, info, reading, content, events);
}

SessionFigures finish_tables(const recording::SessionFolder& folder, recording::SessionInfo info,
                             SessionReader reader) {
    recording::LogHealth whole;
    whole.complete = true;
    whole.last_tick = info.ticks - 1;
    reader.pass_->end(whole);
    const Reading& reading = reader.pass_->reading;
    note_quality(info, reading.figures);
    return write_tables(folder, info, reading, content_of(reading, info, folder),
                        events_of(reading, folder, info));
}

}  // namespace dihaptic::analysis
