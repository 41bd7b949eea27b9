#include "session/study_session.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "base/field_writer.h"
#include "base/regular_file.h"
#include "base/text_file.h"
#include "session/rehearsal.h"
#include "session/resume.h"

namespace dihaptic::session {
namespace {

namespace fs = std::filesystem;

std::string file_of(const study::StudyFile& study) {
    return study.data + "/versions.yaml";
}

/// All versions of a study.
struct Versions {
    std::vector<StudyVersion> versions;

    template <class Visitor>
    void visit(Visitor& v) {
        v("versions", versions);
    }
};

/// An experiment's path as versions.yaml has it: relative to the study, so that the study's folder
/// can be moved.
std::string key_of(const study::StudyFile& study, const std::string& experiment) {
    return fs::path(experiment).lexically_proximate(study.folder).string();
}

Plan plan_of(const std::string& experiment) {
    Request request;
    request.file = experiment;
    request.participant = "1";
    request.order_number = 1;
    return make_plan(request);
}

/// The frozen inputs of an experiment, without its rig.
Node inputs_of(const std::string& experiment) {
    Node out = Node::mapping();
    for (const Node::Entry& entry : rehearsal_of(plan_of(experiment), {}).inputs.entries) {
        if (entry.key != "rig.yaml") out.set(entry.key, entry.value);
    }
    return out;
}

std::optional<study::Visit> visit_in(const std::string& path, size_t session) {
    study::Visit out;
    try {
        const auto folder = recording::SessionFolder::open_tables(path);
        const recording::SessionInfo info = folder.read_info();
        out = {session, path, info.started, info.state == recording::SessionState::complete, 0, 0};
        if (out.complete) return out;
        for (const Unfinished& one : find_unfinished(fs::path(path).parent_path().string(),
                                                     info.title, info.participant.id)) {
            if (fs::path(one.folder).filename() != fs::path(path).filename()) continue;
            out.done = one.done;
            out.trials = one.trials;
        }
    } catch (const Error&) {
        return std::nullopt;  // not a session, or damaged: dihaptic recover reports how
    }
    return out;
}

}  // namespace

std::string session_folder(const study::StudyFile& study, const study::Member& member,
                           size_t session) {
    return fmt::format("{}/sessions/{}/{}", study.data, member.id, study.sessions[session].name);
}

recording::InStudy place_in(const study::StudyFile& study, const study::Member& member,
                            size_t session) {
    return {study.title,
            static_cast<int>(versions_of(study).size()),
            study.shown_group(member.group),
            member.number,
            study.sessions[session].name,
            study.condition_of(session, member.group, member.number)};
}

std::vector<study::Visit> visits_of(const study::StudyFile& study, const study::Member& member) {
    std::vector<study::Visit> out;
    for (size_t i = 0; i < study.sessions.size(); ++i) {
        std::error_code none;  // without a folder nothing was recorded
        for (fs::directory_iterator at(session_folder(study, member, i), none), end;
             !none && at != end; at.increment(none)) {
            if (auto visit = visit_in(at->path().string(), i)) out.push_back(*std::move(visit));
        }
    }
    std::ranges::sort(out, {},
                      [](const study::Visit& v) { return std::pair(v.started, v.folder); });
    return out;
}

study::StudyFile rehearsed(study::StudyFile study) {
    study.data = study.folder + "/rehearsal";
    return study;
}

study::StudyFile checked_study(const std::string& file, Diagnostics& diagnostics) {
    study::StudyFile out = study::read_study(file);
    for (size_t i = 0; i < out.sessions.size(); ++i) {
        for (const std::string& experiment : out.experiments_of(i)) {
            if (!is_there(experiment)) {
                diagnostics.error(out.sessions[i].place, "experiment",
                                  fmt::format("{} does not exist", experiment),
                                  "Correct the name; {group} and {condition} are replaced in it.");
                continue;
            }
            try {
                plan_of(experiment);
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
        for (const std::string& experiment : study.experiments_of(i))
            out.experiments.set(key_of(study, experiment), inputs_of(experiment));
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

std::string changed(const StudyVersion& frozen, const StudyVersion& now, const std::string& file) {
    std::string found = difference(frozen.study, now.study);
    if (!found.empty()) return "the study's file: " + found;
    for (const Node::Entry& entry : now.experiments.entries) {
        if (!file.empty() && entry.key != file) continue;
        const Node* old = frozen.experiments.find(entry.key);
        found = difference(old == nullptr ? Node{} : *old, entry.value);
        if (!found.empty()) return entry.key + ": " + found;
    }
    return "";
}

void check_unchanged(const study::StudyFile& study, const StudyVersion& now,
                     const std::string& file) {
    const std::vector<StudyVersion> versions = versions_of(study);
    if (versions.empty()) return;
    const StudyVersion& frozen = versions.back();
    const std::string what = changed(frozen, now, file.empty() ? "" : key_of(study, file));
    if (what.empty()) return;
    throw Error(
        study.place, "",
        fmt::format("has changed since version {} was frozen, {}: {}", frozen.number, frozen.since,
                    what),
        "Restore the file, or accept it as a new version: dihaptic participant accept STUDY "
        "--why TEXT.");
}

}  // namespace dihaptic::session
