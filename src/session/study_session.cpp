#include "session/study_session.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "analysis/recovery.h"
#include "base/field_writer.h"
#include "base/regular_file.h"
#include "base/text_file.h"
#include "session/rehearsal.h"
#include "session/resume.h"
#include "session/unfinished_folder.h"

namespace dihaptic::session {
namespace {

namespace fs = std::filesystem;

std::string file_of(const study::StudyFile& study) {
    return study.data + "/versions.yaml";
}

/// All versions of a study, as stored in versions.yaml.
struct Versions {
    std::vector<StudyVersion> versions;

    template <class Visitor>
    void visit(Visitor& v) {
        v("versions", versions);
    }
};

Plan plan_of(const std::string& experiment) {
    Request request;
    request.file = experiment;
    request.participant = "1";
    request.order_number = 1;
    return make_plan(request);
}

/// Returns the frozen inputs of an experiment, without its rig.
Node inputs_of(const std::string& experiment) {
    Node out = Node::mapping();
    for (const Node::Entry& entry : rehearsal_of(plan_of(experiment), {}).inputs.entries) {
        if (entry.key != "rig.yaml") out.set(entry.key, entry.value);
    }
    return out;
}

/// Returns the recording in a folder. Throws Error if the folder does not contain a session of this
/// participant: a recording that was ignored would lead to the session being run again.
study::Visit visit_in(const std::string& path, const study::StudyFile& study, size_t session,
                      const study::Member& member, std::string& resumes) {
    const auto folder = recording::SessionFolder::open_tables(path);
    const recording::SessionInfo info = folder.read_info();
    const std::string& id = info.participant.id;
    if (id != member.id && id != recording::simulated_id(member.id)) {
        throw Error({path, 0}, "participant", fmt::format("is '{}', not {}", id, member.id),
                    "Move the folder to where it belongs.");
    }
    const std::string& name = study.sessions[session].name;
    if (!info.in_study || info.in_study->session != name) {
        throw Error({path, 0}, "in_study",
                    info.in_study
                        ? fmt::format("is {} of a study, not {}", info.in_study->session, name)
                        : "is missing: it was recorded outside the study",
                    "Move the folder to where it belongs.");
    }
    const double started = study::seconds_of(info.started);
    if (std::isnan(started)) {
        throw Error({path + "/session.yaml", 0}, "started",
                    fmt::format("'{}' is not a time", shortened(info.started)),
                    "Restore the file, or move the folder away.");
    }
    resumes = fs::path(info.resumes).filename().string();
    const Standing standing = standing_of(folder, info);
    return {session,         path,          started,        standing.complete, standing.running,
            standing.killed, standing.done, standing.trials};
}

/// For each recording that resumes another one, sets its start to the start of the first recording.
void begin_with_first(std::vector<std::pair<study::Visit, std::string>>& found) {
    for (auto& [visit, resumes] : found) {
        for (const auto& [earlier, _] : found) {  // ordered by time
            if (!resumes.empty() && fs::path(earlier.folder).filename() == resumes)
                visit.started = earlier.started;
        }
    }
}

/// Returns the recordings of one session, ordered by start time.
std::vector<study::Visit> visits_in(const study::StudyFile& study, size_t session,
                                    const study::Member& member) {
    const std::string folder = session_folder(study, member, session);
    std::vector<study::Visit> out;
    std::vector<std::pair<study::Visit, std::string>> found;  // with the session that each resumes
    std::vector<std::string> paths;
    if (!is_there(folder)) return out;
    std::error_code failed;
    for (fs::directory_iterator at(folder, failed), end; !failed && at != end; at.increment(failed))
        paths.push_back(at->path().string());
    if (failed) {
        throw Error({folder, 0}, "", "cannot be read: " + failed.message(),
                    "Recordings in it would not count: correct its permissions.");
    }
    for (const std::string& path : paths) {
        const std::string name = fs::path(path).filename().string();
        if (name.starts_with(kUnfinished) || name.starts_with('.')) continue;  // e.g. .DS_Store
        auto& [visit, resumes] = found.emplace_back();
        visit = visit_in(path, study, session, member, resumes);
    }
    // by time, not by name: names contain local times
    std::ranges::sort(found, {},
                      [](const auto& f) { return std::pair(f.first.started, f.first.folder); });
    begin_with_first(found);
    for (const auto& [visit, resumes] : found) out.push_back(visit);
    return out;
}

/// Warns about experiments whose names reveal a concealed group to anyone who sees a recording.
void check_concealed(const study::StudyFile& study, Diagnostics& diagnostics) {
    for (const study::SessionSpec& session : study.sessions) {
        if (!study.allocation.concealed || session.experiment.find("{group}") == std::string::npos)
            continue;
        diagnostics.warning(session.place, "experiment",
                            "names the concealed group in the recordings: their folders are named "
                            "after the experiment's file",
                            "Give the groups names that say nothing, such as a and b.");
    }
}

/// Warns about a group in which orders do not occur equally often. `what`: what has these orders.
void check_balance(const study::Group& group, const std::string& what, int orders,
                   Diagnostics& diagnostics) {
    if (group.people % orders == 0) return;
    diagnostics.warning(group.place, "people",
                        fmt::format("is {}: the {} have {} orders, which do not come up equally "
                                    "often",
                                    group.people, what, orders),
                        fmt::format("Use a multiple of {}, or accept the imbalance.", orders));
}

/// Warns about orders within the experiments of a study, for each group that does them.
void check_orders(const study::StudyFile& study, const study::SessionSpec& session,
                  const std::string& name, const Plan& plan, Diagnostics& diagnostics) {
    if (!plan.task) return;
    for (const task::NumberedOrder& numbered : task::numbered_orders(plan.task->task)) {
        for (const study::Group& group : study.groups) {
            if (study.is_done_by(session, name, group))
                check_balance(group, fmt::format("{} in {}", numbered.of, name), numbered.orders,
                              diagnostics);
        }
    }
}

}  // namespace

std::string session_folder(const study::StudyFile& study, const study::Member& member,
                           size_t session) {
    return fmt::format("{}/sessions/{}/{}", study.data, member.id, study.sessions[session].name);
}

recording::InStudy place_in(const study::StudyFile& study, const study::Member& member,
                            size_t session) {
    std::vector<recording::Fact> facts = member.facts;
    if (study.allocation.concealed)  // groups may be the values of a participant's fact
        std::erase_if(facts, [&](const auto& fact) { return fact.name == study.allocation.fact; });
    return {study.title,
            static_cast<int>(versions_of(study).size()),
            study.shown_group(member.group),
            member.number,
            study.sessions[session].name,
            study.condition_of(session, member.group, member.number),
            std::move(facts)};
}

std::vector<study::Visit> visits_of(const study::StudyFile& study, const study::Member& member) {
    std::vector<study::Visit> out;
    for (size_t i = 0; i < study.sessions.size(); ++i) {
        const auto some = visits_in(study, i, member);
        out.insert(out.end(), some.begin(), some.end());
    }
    return out;
}

bool counts_in_study(const std::string& recorded, const recording::InStudy& place) {
    std::error_code failed;
    const fs::path here = fs::canonical(recorded, failed);
    const fs::path person = here.parent_path().parent_path();
    const fs::path beside = person.parent_path().parent_path();
    for (fs::directory_iterator at(beside, failed), end; !failed && at != end;
         at.increment(failed)) {
        const std::string kind = at->path().extension().string();
        if (kind != ".yaml" && kind != ".yml") continue;
        try {
            const study::StudyFile study = study::read_study(at->path().string());
            const study::Roster roster = study::read_roster(study);
            const auto member = std::ranges::find(roster.participants, person.filename().string(),
                                                  &study::Member::id);
            const auto spec =
                std::ranges::find(study.sessions, place.session, &study::SessionSpec::name);
            if (study.title != place.study || member == roster.participants.end() ||
                spec == study.sessions.end())
                continue;
            const auto visits = visits_of(study, *member);
            const study::Visit* const visit =
                study::counted(study, visits, static_cast<size_t>(spec - study.sessions.begin()));
            return visit != nullptr && fs::equivalent(visit->folder, here, failed);
        } catch (const Error&) {
            continue;  // not a study, or a study whose recordings cannot be read
        }
    }
    return false;
}

bool recover_killed(const std::vector<study::Visit>& visits,
                    const std::function<void(const std::string& folder)>& tell) {
    bool any = false;
    for (const study::Visit& visit : visits) {
        if (!visit.killed) continue;
        any = true;
        tell(visit.folder);
        analysis::recover_session(recording::SessionFolder::open(visit.folder), [](double) {});
    }
    return any;
}

std::string deletable(const study::StudyFile& study, const study::Member& member) {
    const fs::path folder = fs::path(session_folder(study, member, 0)).parent_path();
    for (const fs::path& part : {folder.parent_path(), folder}) {
        if (!fs::is_symlink(part)) continue;
        throw Error({part.string(), 0}, "", "is a link, and nothing is deleted through links",
                    "Delete the recordings where they are, then withdraw with --keep-data.");
    }
    if (!is_there(folder.string())) return "";
    for (const auto& entry : fs::recursive_directory_iterator(folder)) {
        if (entry.path().filename() != "session.yaml") continue;
        const std::string session = entry.path().parent_path().string();
        if (!is_there(session + "/raw.log")) continue;
        const recording::SessionLock lock(recording::SessionFolder::open(session));
    }
    return folder.string();
}

std::vector<std::string> uncounted(const study::StudyFile& study, const study::Member& member) {
    std::vector<std::string> out;
    std::error_code none;
    const fs::path folder = fs::path(session_folder(study, member, 0)).parent_path();
    for (fs::directory_iterator at(folder, none), end; !none && at != end; at.increment(none)) {
        const std::string name = at->path().filename().string();
        if (std::ranges::find(study.sessions, name, &study::SessionSpec::name) ==
            study.sessions.end())
            out.push_back(at->path().string());
    }
    return out;
}

study::StudyFile rehearsed(study::StudyFile study) {
    study.data = study.folder + "/rehearsal";
    return study;
}

study::StudyFile checked_study(const std::string& file, Diagnostics& diagnostics) {
    study::StudyFile out = study::read_study(file);
    check_concealed(out, diagnostics);
    for (const study::Group& group : out.groups)
        check_balance(group, "conditions", out.orders(), diagnostics);
    for (size_t i = 0; i < out.sessions.size(); ++i) {
        for (const auto& [name, experiment] : out.experiments_of(i)) {
            if (!is_there(experiment)) {
                diagnostics.error(out.sessions[i].place, "experiment",
                                  fmt::format("{} does not exist", experiment),
                                  "Correct the name; {group} and {condition} are replaced in it.");
                continue;
            }
            try {
                check_orders(out, out.sessions[i], name, plan_of(experiment), diagnostics);
            } catch (const Error& e) {
                diagnostics.add(e.problems());
            }
        }
    }
    return out;
}

StudyVersion present_version(const study::StudyFile& study) {
    StudyVersion out;
    out.program = recording::program_version();
    out.study = write_fields(study);
    out.experiments = Node::mapping();
    for (size_t i = 0; i < study.sessions.size(); ++i) {
        for (const auto& [name, file] : study.experiments_of(i))
            out.experiments.set(name, inputs_of(file));
    }
    return out;
}

std::vector<StudyVersion> versions_of(const study::StudyFile& study) {
    Versions out;
    if (!is_there(file_of(study))) return {};
    Diagnostics diagnostics;
    read_fields(out, read_yaml(file_of(study)), diagnostics);
    diagnostics.throw_if_errors();
    return out.versions;
}

int freeze(const study::StudyFile& study, StudyVersion version, const std::string& why) {
    Versions all{versions_of(study)};
    version.number = static_cast<int>(all.versions.size()) + 1;
    version.since = recording::iso_now();
    version.why = why;
    all.versions.push_back(std::move(version));
    write_file("# Written by dihaptic participant: the files of the study as they were.\n" +
                   to_yaml(write_fields(all)),
               file_of(study), Keep::at_once);
    return all.versions.back().number;
}

std::string changed(const StudyVersion& frozen, const StudyVersion& now) {
    std::string found = difference(frozen.study, now.study);
    if (!found.empty()) return "the study's file: " + found;
    for (const Node::Entry& entry : now.experiments.entries) {
        const Node* old = frozen.experiments.find(entry.key);
        found = difference(old == nullptr ? Node{} : *old, entry.value);
        if (!found.empty()) return entry.key + ": " + found;
    }
    return "";
}

void check_unchanged(const study::StudyFile& study, const StudyVersion& now) {
    const std::vector<StudyVersion> versions = versions_of(study);
    if (versions.empty()) {
        if (study::read_roster(study).participants.empty()) return;
        throw Error({file_of(study), 0}, "", "has no version, though there are participants",
                    "Restore it: it says whether the study's files have changed.");
    }
    const StudyVersion& frozen = versions.back();
    const std::string what = changed(frozen, now);
    if (what.empty()) return;
    throw Error(
        study.place, "",
        fmt::format("has changed since version {} was frozen, {}: {}", frozen.number, frozen.since,
                    what),
        "Restore the file, or accept it as a new version: dihaptic participant accept STUDY "
        "--why TEXT.");
}

}  // namespace dihaptic::session
