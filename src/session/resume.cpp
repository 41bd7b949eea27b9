#include "session/resume.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <optional>
#include <set>

#include "analysis/recovery.h"
#include "base/field_reader.h"
#include "base/plural.h"
#include "base/regular_file.h"
#include "base/shell_word.h"
#include "base/text_file.h"
#include "recording/raw_log.h"
#include "rows/trial_row.h"
#include "session/seated_people.h"

namespace dihaptic::session {
namespace {

namespace fs = std::filesystem;
using recording::Mover;
using recording::SessionState;

/// Name of the file, in the folder of a resumed session, that contains the path of the session that
/// resumed it.
constexpr const char* kResumedAs = "resumed-as";

/// Puts the session's simulated person back into the plan, with the same traits. What the person
/// had learned is lost.
void sit_down_again(Plan& plan, const recording::SessionFolder& folder) {
    const std::string file = folder.file("person.yaml");
    if (!is_there(file)) {
        throw Error({file, 0}, "", "is missing: it contained the simulated person's traits",
                    "Restore it, or rehearse the experiment again.");
    }
    const Node node = read_yaml(file);
    if (node.find("class") != nullptr) {
        throw Error({file, 0}, "class", "names a person written in Python",
                    "Run the experiment again with that person: dihaptic.run(person=...).");
    }
    Diagnostics diagnostics;
    SeatedPeople seated;
    read_fields(seated, node, diagnostics);
    diagnostics.throw_if_errors();
    sit_down(plan, seated.person, seated.partner);
}

const char* who_goes_on(Mover mover) {
    switch (mover) {
        case Mover::devices:
            return "a person holds the devices, as before";
        case Mover::mouse:
            return "a person moves the hand by mouse, as before";
        case Mover::script:
            return "the file's script moves the hand, as before";
        case Mover::simulated_person:
            return "the same simulated person moves the hand, as before; its learning is lost";
        default:
            return "";
    }
}

/// Returns the rows of a table; empty if the table is missing or cannot be read.
template <class Row>
std::vector<Row> rows_in(const std::string& file) {
    try {
        const rows::RowFile<Row> table(file);
        return {table.begin(), table.end()};
    } catch (const Error&) {
        return {};
    }
}

/// Number of trials with at least one attempt that ended, including trials that must be repeated.
size_t trials_done(const recording::SessionFolder& folder) {
    std::set<int> done;  // a trial may have several attempts
    for (const rows::TrialRow& row : rows_in<rows::TrialRow>(folder.file("trials.csv"))) {
        if (row.measures.outcome != rows::kInterrupted) done.insert(row.asked.trial);
    }
    return done.size();
}

/// Whether no program is recording or recovering the session at present.
bool at_rest(const recording::SessionFolder& folder) {
    try {
        const recording::SessionLock lock(folder);
        return true;
    } catch (const Error&) {
        return false;
    }
}

/// Whether the session has trials left. If its files were changed after the session ended, returns
/// true, so that rest_of() can report the change and the remedy.
bool may_go_on(const recording::SessionFolder& folder) {
    try {
        return trials_left(folder.path());
    } catch (const Error&) {
        return true;
    }
}

/// Returns the session if some of its trials are not done; otherwise nullopt.
std::optional<Unfinished> unfinished(const recording::SessionFolder& folder,
                                     const recording::SessionInfo& info) {
    if (!is_there(folder.file("task.yaml")) || info.state == SessionState::complete ||
        !at_rest(folder))
        return std::nullopt;
    // a killed session has no tables yet
    const bool killed = info.state == SessionState::running;
    if (!killed && !may_go_on(folder)) return std::nullopt;
    const auto list = rows_in<rows::AskedRow>(folder.file("trial-list.csv"));
    return Unfinished{folder.path(), info.started, trials_done(folder), list.size(), info.moved_by};
}

/// Returns the session in the folder `parent` that resumes the session called `name`; "" if there
/// is none.
std::string successor(const std::string& name, const std::string& parent) {
    std::error_code failed;
    for (fs::directory_iterator i(parent, failed), end; !failed && i != end; i.increment(failed)) {
        try {
            const auto folder = recording::SessionFolder::open(i->path().string());
            if (fs::path(folder.read_info().resumes).filename() == name) return folder.path();
        } catch (const Error&) {
            continue;  // not a session, or damaged
        }
    }
    return "";
}

[[noreturn]] void refuse_again(const std::string& session, const std::string& next) {
    throw Error({session, 0}, "", fmt::format("has already been resumed, as {}", next),
                fmt::format("Continue with that session: dihaptic resume {}. If it should not "
                            "count, move its folder elsewhere.",
                            shell_file(next)));
}

void check_not_resumed(const std::string& session, const std::string& out) {
    const fs::path folder = fs::canonical(session);
    if (const std::string note = folder / kResumedAs; is_there(note)) {
        std::string next = read_text_file(note, 10'000);
        if (next.ends_with('\n')) next.pop_back();
        if (is_there(next + "/session.yaml")) refuse_again(session, next);
    }
    for (const std::string& parent : {folder.parent_path().string(), out}) {
        const std::string next = successor(folder.filename().string(), parent);
        if (!next.empty()) refuse_again(session, next);
    }
}

}  // namespace

Standing standing_of(const recording::SessionFolder& folder, const recording::SessionInfo& info) {
    Standing out;
    out.complete = info.state == SessionState::complete;
    if (out.complete) return out;
    out.running = !at_rest(folder);
    out.killed = !out.running && info.state == SessionState::running;
    if (!is_there(folder.file("task.yaml"))) return out;
    out.complete = !out.running && !out.killed && !may_go_on(folder);
    out.done = trials_done(folder);
    out.trials = rows_in<rows::AskedRow>(folder.file("trial-list.csv")).size();
    return out;
}

void note_successor(const std::string& session, const std::string& next) {
    write_file(fs::absolute(next).lexically_normal().string() + "\n", session + "/" + kResumedAs);
}

recording::SessionLock claim(const std::string& session, const std::string& out) {
    const auto folder = recording::SessionFolder::open(session);
    recording::SessionLock lock(folder);
    check_not_resumed(folder.path(), out);
    return lock;
}

std::string Rest::describe() const {
    return fmt::format("resumes {}: {} done\n{}\n", plan.resumes,
                       counted(static_cast<int64_t>(plan.done.size()), "attempt"),
                       who_goes_on(plan.moved_by.mover));
}

Rest rest_of(const std::string& session, Seat seat, const std::function<void(double)>& progress) {
    const auto folder = recording::SessionFolder::open(session);
    check_not_resumed(folder.path(), "");
    Rest out;
    Diagnostics ignored;  // recover_session() reports the same problems
    const recording::RawLogReader log(folder.raw_log());
    if (folder.read_info(log.head(), ignored).state == SessionState::running)
        out.warnings = analysis::recover_session(folder, progress).warnings;
    out.plan = make_rest(session, seat, out.before);
    if (out.plan.moved_by.mover == Mover::simulated_person) {
        sit_down_again(out.plan, folder);
        out.plan.moved_by.seed = out.before.moved_by.seed;  // the person was drawn with this seed
    }
    return out;
}

std::vector<Unfinished> find_unfinished(const std::string& parent, const std::string& title,
                                        const std::string& participant) {
    std::vector<Unfinished> out;
    std::set<std::string> gone_on_with;
    std::error_code failed;  // if the folder does not exist, there are no sessions
    for (fs::directory_iterator i(parent, failed), end; !failed && i != end; i.increment(failed)) {
        try {
            const auto folder = recording::SessionFolder::open(i->path().string());
            const recording::SessionInfo info = folder.read_info();
            if (!info.resumes.empty())
                gone_on_with.insert(fs::path(info.resumes).filename().string());
            if (info.title != title || info.participant.id != participant) continue;
            if (auto found = unfinished(folder, info)) out.push_back(*std::move(found));
        } catch (const Error&) {
            continue;  // not a session, or damaged
        }
    }
    std::erase_if(out, [&](const Unfinished& session) {
        return gone_on_with.contains(fs::path(session.folder).filename().string());
    });
    std::sort(out.begin(), out.end(),
              [](const Unfinished& a, const Unfinished& b) { return a.folder > b.folder; });
    return out;
}

}  // namespace dihaptic::session
