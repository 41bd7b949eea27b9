#include "analysis/report/session_data.h"

#include <algorithm>
#include <filesystem>
#include <map>
#include <set>

#include "base/regular_file.h"
#include "base/shell_word.h"
#include "recording/seal.h"
#include "rows/phase_row.h"
#include "task/plan/trials.h"

namespace dihaptic::analysis {

namespace fs = std::filesystem;

namespace {

std::vector<Problem> changed_of(const recording::SessionFolder& folder,
                                const recording::SessionInfo& info) {
    constexpr std::string_view kRead[] = {"trials.csv", "lifts.csv", "procedures.csv"};
    std::vector<Problem> out = recording::broken_seals(folder, info, Severity::warning, kRead);
    const std::vector<Problem> inputs = folder.changed(info.inputs, Severity::warning);
    out.insert(out.end(), inputs.begin(), inputs.end());
    return out;
}

/// Reads trials.csv. Throws Error when the table cannot be read; the message states what is known
/// about the original table.
rows::TrialFile trials_of(const recording::SessionFolder& folder,
                          const std::vector<Problem>& changed) {
    try {
        return rows::TrialFile(folder.file("trials.csv"));
    } catch (const Error& e) {
        std::vector<Problem> problems = e.problems();
        problems.insert(problems.end(), changed.begin(), changed.end());
        throw Error(problems);
    }
}

/// Takes the rules of staircases from the task, since the recorded procedures do not contain them.
void note_staircases(std::vector<ThresholdTrack>& tracks, const task::Task& task) {
    for (ThresholdTrack& track : tracks) {
        for (const task::ProcedureSpec& spec : task.procedures) {
            if (spec.name != track.procedure || !spec.staircase) continue;
            track.down_after = spec.staircase->down_after;
            track.skipped_reversals = spec.staircase->skipped_reversals;
        }
    }
}

/// Whether the cursor is hidden in this state, for trials of this round and condition.
bool hides_cursor(const task::Task& task, const std::string& state, const rows::AskedRow& asked) {
    for (const task::State& one : task.states) {
        if (one.name == state && one.show.cursor == task::Cursor::no) return true;
    }
    const auto hides = [&](const task::LookSpec& look) {
        const bool now = look.during.empty() || std::ranges::find(look.during, state) !=
                                                    static_cast<const Texts&>(look.during).end();
        const std::string& reaches = task.reach->finger;
        return look.hidden && now && !look.finger.empty() &&
               (reaches.empty() || look.finger == reaches);
    };
    const auto of = [&](const std::vector<task::Condition>& list, const std::string& name) {
        return std::ranges::any_of(list, [&](const task::Condition& c) {
            return c.name == name && std::ranges::any_of(c.look, hides);
        });
    };
    return of(task.conditions, asked.condition) || of(task.rounds, asked.round);
}

/// Whether the cursor is frozen in this state, to give feedback on a movement that has ended.
bool holds_cursor(const task::Task& task, const std::string& state) {
    return std::ranges::any_of(task.states, [&](const task::State& one) {
        return one.name == state && one.show.cursor == task::Cursor::held;
    });
}

/// Notes that no error was seen in reaches with a hidden cursor, unless the end point of the reach
/// was shown later in the trial.
void note_hidden_cursor(SessionData& data) {
    if (!data.task.reach || !is_there(data.folder.file("phases.csv"))) return;
    const auto& during = data.task.reach->during;
    std::map<int, std::string> state;     // state in which the last reach of a trial was made
    std::map<int, std::string> feedback;  // later state in which its end point is shown
    for (const rows::PhaseRow& phase : rows::PhaseFile(data.folder.file("phases.csv"))) {
        const auto& names = static_cast<const Texts&>(during);
        if (std::ranges::find(names, phase.name) != names.end()) {
            state[phase.trial] = phase.name;
            feedback.erase(phase.trial);
        } else if (state.contains(phase.trial) && holds_cursor(data.task, phase.name)) {
            feedback[phase.trial] = phase.name;
        }
    }
    std::set<int> hidden;
    for (const rows::TrialRow& row : data.trials) {
        const auto hid = [&](const std::map<int, std::string>& states) {
            const auto at = states.find(row.asked.trial);
            return at == states.end() || hides_cursor(data.task, at->second, row.asked);
        };
        if (state.contains(row.asked.trial) && hid(state) && hid(feedback))
            hidden.insert(row.asked.trial);
    }
    for (AdaptationCurve& curve : data.curves) {
        for (AdaptationCurve::Trial& trial : curve.trials) {
            if (!hidden.contains(trial.number)) continue;
            trial.clamp = true;
            trial.perturbation = 0;
        }
    }
}

/// Computes the adaptation curves and the generalisation.
void find_curves(SessionData& data) {
    const bool in_channels = has_adaptation_index(data.trials);
    if (in_channels)
        std::erase_if(data.unmeasured,
                      [](const auto& of) { return of.second.starts_with("a force"); });
    data.curves = adaptation_curves(data.trials, data.unmeasured);
    const std::string errors = column_of_errors(data.task);
    const bool in_errors = !errors.empty() && data.trials.column(errors);
    if (in_errors) {
        data.curves = error_curves(data.trials, errors);
        data.unmeasured.clear();  // the curves' notes say what is not visible
    }
    if (!in_channels && !in_errors) note_hidden_cursor(data);
    // the hand's angle does not show the learning of a force channel or a force field
    if (!data.curves.empty() && !in_channels && !in_errors && data.unmeasured.empty() &&
        is_there(data.folder.file("trial-list.csv")))
        data.generalisation = find_generalisation(
            data.trials, task::read_reaches(data.folder.file("trial-list.csv")));
}

}  // namespace

SessionData SessionData::read(const std::string& path) {
    recording::SessionFolder folder = recording::SessionFolder::open_tables(path);
    recording::SessionInfo info = folder.read_info();
    if (info.state == recording::SessionState::running) {
        throw Error({folder.file("session.yaml"), 0}, "", "the session has not ended",
                    "If it was killed, run: dihaptic recover " + shell_file(folder.path()));
    }
    const std::vector<Problem> changed = changed_of(folder, info);
    SessionData data{folder,
                     info,
                     read_frozen_task(folder.file("task.yaml")),
                     trials_of(folder, changed),
                     std::nullopt,
                     {},
                     {},
                     {},
                     changed,
                     {}};
    for (const auto& [name, what] : unmeasured_perturbations(data.task)) {
        for (const rows::TrialRow& row : data.trials) {
            if (!task::names_perturbation(row.asked.perturbation, name)) continue;
            data.unmeasured[name] = what;
            break;
        }
    }
    if (is_there(folder.file("lifts.csv")))
        data.lifts.emplace(rows::read_lifts(folder.file("lifts.csv")));
    find_curves(data);
    if (is_there(folder.file("procedures.csv")))
        data.tracks =
            threshold_tracks(data.trials, rows::ProcedureFile(folder.file("procedures.csv")));
    note_staircases(data.tracks, data.task);
    return data;
}

bool SessionData::is_cut_short() const {
    if (!is_there(folder.file("trial-list.csv"))) return false;
    if (info.state == recording::SessionState::interrupted) return true;
    // for a killed session, the last trial decides whether it was complete
    return info.state == recording::SessionState::recovered &&
           (trials.empty() || trials.back().measures.outcome == rows::kInterrupted);
}

bool SessionData::stands_in() const {
    const fs::path of_participant = fs::path(folder.path()).parent_path().parent_path();
    return info.in_study &&
           info.participant.id == recording::kSimulatedPrefix + of_participant.filename().string();
}

std::string SessionData::not_measured() const {
    std::string out;
    for (const auto& [name, what] : unmeasured)
        out += (out.empty() ? "" : "; ") + name + " is " + what;
    return out;
}

std::vector<std::string> find_sessions(const std::string& folder) {
    std::vector<std::string> out;
    const auto options = fs::directory_options::skip_permission_denied;
    for (const auto& entry : fs::recursive_directory_iterator(folder, options)) {
        if (entry.path().filename() == "session.yaml")
            out.push_back(entry.path().parent_path().string());
    }
    std::sort(out.begin(), out.end());
    return out;
}

std::vector<std::string> groups_of_lifts(const SessionData& session) {
    std::map<std::pair<int, int>, std::string> groups;  // indexed by trial and attempt
    for (const rows::TrialRow& row : session.trials) {
        std::string group;
        const auto add = [&](std::string_view text) {
            if (!text.empty()) group += (group.empty() ? "" : ", ") + std::string(text);
        };
        add(row.asked.round);
        add(row.asked.block);
        // a block is often named after its kind; without a task there is neither
        const std::string_view kind = enum_name(row.asked.kind);
        if (!row.asked.block.empty() && !group.ends_with(kind)) add(kind);
        add(row.asked.condition);
        groups[{row.asked.trial, row.measures.attempt}] = group;
    }
    std::vector<std::string> out;
    if (!session.lifts) return out;
    for (const rows::LiftRow& lift : *session.lifts) {
        const auto found = groups.find({lift.trial, lift.attempt});
        out.push_back(found == groups.end() ? "" : found->second);
    }
    return out;
}

}  // namespace dihaptic::analysis
